// SPDX-License-Identifier: GPL-3.0-or-later
// Small recordings for the tests of reports.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/cube_scene.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/replay_csv.hpp"

namespace palpate::test {

/// Rows that differ from each other in every figure.
inline std::vector<cli::TickRow> some_ticks(std::size_t count) {
  std::vector<cli::TickRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    rows[i].t_s = 0.001 * x;
    rows[i].wrench.force_N = {0.1 * x, 0, 0};
    rows[i].min_distance_m = i == 0 ? std::nan("") : 1e-4 / x;
    rows[i].front_nodes = 10 + i;
    rows[i].time_ns = 1000 * (i + 1);
    rows[i].certificate.error_bound_m = 1e-5 * (x + 1);
  }
  return rows;
}

/// The message of the failure that `act` ends with; empty where it does not fail.
template <class Act>
std::string failure_of(Act act) {
  try {
    act();
  } catch (const cli::Failure& e) {
    return e.what();
  }
  return {};
}

}  // namespace palpate::test
