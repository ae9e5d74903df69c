// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark's scene where the real-time loop asks for contacts.
#pragma once

#include "tools/bench/scenes.hpp"
#include "tools/realtime/contact_query.hpp"

namespace palpate::bench {

/// Bench::tick_at() at the pose of the tool; never fails.
class BenchQuery final : public realtime::ContactQuery {
 public:
  explicit BenchQuery(Bench& bench) : bench_(bench) {}
  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override {
    out = bench_.tick_at(tool, budget);
    return Status::ok;
  }

 private:
  Bench& bench_;
};

}  // namespace palpate::bench
