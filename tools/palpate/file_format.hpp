// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files that are written.
#pragma once

#include <string>
#include <string_view>

#include "tools/palpate/command.hpp"

namespace palpate::cli {

/// What is wrong with a name that ends as one of another format, as "part.stl" where PLY is
/// written: other programs go by it. Empty: nothing.
/// @param extension  of what is written, with its dot, in small letters; static
std::string wrong_name(const std::string& file, std::string_view extension);

/// The same for options.
CLI::Validator named_as(std::string_view extension);

}  // namespace palpate::cli
