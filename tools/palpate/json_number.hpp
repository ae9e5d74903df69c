// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that JSON has no word for.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace palpate::cli {

/// null where the value is not finite.
inline nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace palpate::cli
