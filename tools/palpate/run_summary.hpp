// SPDX-License-Identifier: GPL-3.0-or-later
// What a run of the real-time loop did, for people and for programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/realtime/loop.hpp"
#include "tools/realtime/realtime_thread.hpp"

namespace palpate::cli {

struct RunOutcome {
  std::filesystem::path scene;
  std::string device;
  double rate_Hz = 0;
  std::optional<double> budget_us;  ///< absent: the period's share alone
  /// Contact queries that ended after their period; absent: the loop asked them itself.
  std::optional<std::uint64_t> contacts_late;
  realtime::LoopReport report;
  realtime::HostGrant grant;
  std::optional<std::filesystem::path> trace;
  std::uint64_t telemetry_dropped = 0;
};

/// What a run promises and this one did not keep, each as a clause; empty where all is well.
std::vector<std::string> broken_promises(const RunOutcome& outcome);

/// A page worth reading, with a small histogram of wake-up lateness and tick time.
std::string run_text(const RunOutcome& outcome);

/// The object documented for `run --json`, and more keys of the same kind. `allocations` is null in
/// builds that cannot count them.
nlohmann::json run_json(const RunOutcome& outcome);

}  // namespace palpate::cli
