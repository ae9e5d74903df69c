// SPDX-License-Identifier: GPL-3.0-or-later
// The last words of a program that failed.
#pragma once

#include <string>

namespace palpate::cli {

/// `PROGRAM: error: MESSAGE` on stderr, in one line whatever the message holds.
void print_error(const char* program, std::string message);

/// The message for an exception that nothing else knows. Call it in a handler.
std::string internal_error();

}  // namespace palpate::cli
