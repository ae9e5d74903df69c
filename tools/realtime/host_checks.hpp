// SPDX-License-Identifier: GPL-3.0-or-later
// Is this host ready for the loop? One check a fact, each with the command that fixes it.
// docs/REALTIME.md explains them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpate::realtime {

struct HostCheck {
  std::string check;  ///< a stable name, snake_case
  bool ok = false;
  std::string found;
  std::string wanted;
  std::string fix;  ///< a command or what to change; empty where ok
};

/// What the kernel permits this process.
struct HostRights {
  std::uint64_t max_fifo_priority = 0;  ///< RLIMIT_RTPRIO; the largest number: any
  std::uint64_t max_locked_bytes = 0;   ///< RLIMIT_MEMLOCK; the largest number: unlimited
  bool any_priority = false;            ///< CAP_SYS_NICE
  bool any_memory = false;              ///< CAP_IPC_LOCK
};

[[nodiscard]] HostRights host_rights();

/// What readies a host: beside an installed executable, else of the sources, relative to them.
[[nodiscard]] std::filesystem::path set_up_script();

/// All checks, in a fixed order. Reads small files below /proc, /sys and /dev.
/// @param root  where those lie; tests give a copy
/// @param script  the one that a host is readied with
[[nodiscard]] std::vector<HostCheck> check_host(
    const HostRights& rights, const std::filesystem::path& root = "/",
    const std::filesystem::path& script = "tools/setup/host");

}  // namespace palpate::realtime
