// SPDX-License-Identifier: GPL-3.0-or-later
// Changes in the text of a scene that leave alone what they are not about.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace palpate::cli {

/// The text of a scene with the values of [engine] and the images of `wanted`: comments, order and
/// what else was written stay. Where that cannot be done (inline tables, dotted keys) `wanted` is
/// written anew, without comments.
/// @param text    TOML
/// @param wanted  what `text` holds, but for values of [engine] and images
std::string edited_scene(const std::string& text, const toml::table& wanted);

}  // namespace palpate::cli
