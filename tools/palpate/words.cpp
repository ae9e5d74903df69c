// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/words.hpp"

#include <algorithm>

#include <cstdarg>
#include <cstdio>

namespace palpate::cli {

std::string format(const char* pattern, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

std::string count_of(std::uint64_t count, const char* one, const char* many) {
  return grouped(count) + " " + (count == 1 ? one : many);
}

std::string duration(std::uint64_t ns) {
  const double value = static_cast<double>(ns);
  if (ns < 1000) return format("%.0f ns", value);
  if (ns < 1'000'000) return format("%.1f µs", value / 1e3);
  return format("%.2f ms", value / 1e6);
}

std::string right_aligned(const std::string& text, std::size_t columns) {
  // Of a letter's bytes in UTF-8 all but the first begin with 10.
  const auto used = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
  return std::string(columns > used ? columns - used : 0, ' ') + text;
}

std::string hex(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  out.reserve(2 * bytes.size());
  for (const std::uint8_t b : bytes) {
    out += kDigits[b >> 4];
    out += kDigits[b & 15];
  }
  return out;
}

}  // namespace palpate::cli
