// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/host_files.hpp"

#include <fstream>
#include <sstream>

namespace palpate::realtime {

std::optional<std::string> first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in) return std::nullopt;
  std::getline(in, line);
  return line;
}

std::set<int> processors_in(const std::string& list) {
  std::set<int> out;
  std::istringstream ranges(list);
  for (std::string range; std::getline(ranges, range, ',');) {
    std::istringstream numbers(range);
    int first = 0, last = 0;
    char dash = 0;
    if (!(numbers >> first)) return {};
    if (!(numbers >> dash >> last)) last = first;
    for (int cpu = first; cpu <= last; ++cpu) out.insert(cpu);
  }
  return out;
}

std::set<int> processors_in_mask(const std::string& mask) {
  std::set<int> out;
  int cpu = 0;
  for (auto digit = mask.rbegin(); digit != mask.rend(); ++digit) {
    if (*digit == ',') continue;
    const std::string text(1, *digit);
    const auto value = std::string("0123456789abcdef").find(text);
    for (int bit = 0; value != std::string::npos && bit < 4; ++bit) {
      if ((value >> bit & 1u) != 0) out.insert(cpu + bit);
    }
    cpu += 4;
  }
  return out;
}

void append(std::string& list, const char* between, const std::string& text) {
  if (!list.empty()) list += between;
  list += text;
}

}  // namespace palpate::realtime
