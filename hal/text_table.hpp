// SPDX-License-Identifier: Apache-2.0
// What numbered errors and states are called: one table each, looked up here. Freestanding.
#pragma once

#include <initializer_list>

namespace palpate::hal {

template <class Number>
struct Text {
  Number number;
  const char* text;
};

/// The text of a number, which has static storage; the other one where it has none.
template <class Number>
[[nodiscard]] constexpr const char* text_in(std::initializer_list<Text<Number>> table,
                                            Number number, const char* otherwise) noexcept {
  for (const Text<Number>& entry : table) {
    if (entry.number == number) return entry.text;
  }
  return otherwise;
}

}  // namespace palpate::hal
