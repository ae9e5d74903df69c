// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files that are written.
#pragma once

#include <string_view>

#include "tools/palpate/command.hpp"

namespace palpate::cli {

/// For options: refuses a name that ends as one of another format, as "part.stl" where PLY is
/// written. Other programs go by it.
/// @param extension  of what is written, with its dot, in small letters; static
CLI::Validator named_as(std::string_view extension);

}  // namespace palpate::cli
