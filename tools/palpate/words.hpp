// SPDX-License-Identifier: GPL-3.0-or-later
// Figures in the words of a summary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace palpate::cli {

/// printf into a string of at most 255 characters.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// 12345678 as "12,345,678".
std::string grouped(std::uint64_t value);

/// "1 tick", "2,000 ticks".
std::string count_of(std::uint64_t count, const char* one, const char* many);

/// With the unit that fits: "812 ns", "15.1 µs", "13.42 ms".
std::string duration(std::uint64_t ns);

/// With blanks before it, where it takes less than so many columns of a terminal.
std::string right_aligned(const std::string& text, std::size_t columns);

/// Two lower-case digits a byte.
std::string hex(std::span<const std::uint8_t> bytes);

}  // namespace palpate::cli
