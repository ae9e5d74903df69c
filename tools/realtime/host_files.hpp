// SPDX-License-Identifier: GPL-3.0-or-later
// What the checks of a host read: small files below /proc and /sys.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "tools/realtime/host_checks.hpp"

namespace palpate::realtime {

/// Of the loop, where nothing else is asked for.
inline constexpr int kLoopPriority = 80;

/// The first line of a small file; absent where it cannot be read.
[[nodiscard]] std::optional<std::string> first_line(const std::filesystem::path& file);

/// "0-2,5" as the kernel lists processors; what is no list gives none.
[[nodiscard]] std::set<int> processors_in(const std::string& list);

/// A mask of processors in hexadecimal, with commas between words: "ff,00000001".
[[nodiscard]] std::set<int> processors_in_mask(const std::string& mask);

/// Adds to a list in words.
void append(std::string& list, const char* between, const std::string& text);

[[nodiscard]] inline HostCheck make_check(std::string name, bool ok, std::string found,
                                          std::string wanted, std::string fix) {
  return {std::move(name), ok, std::move(found), std::move(wanted), ok ? "" : std::move(fix)};
}

}  // namespace palpate::realtime
