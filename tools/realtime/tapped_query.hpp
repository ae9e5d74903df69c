// SPDX-License-Identifier: GPL-3.0-or-later
// A query whose contacts a live view sees.
#pragma once

#include "tools/realtime/contact_query.hpp"
#include "tools/realtime/live_tap.hpp"

namespace palpate::realtime {

/// Another query's answers, unchanged; every n-th of them is copied for the view. Next to the
/// engine, where contacts are still those of the thread that asks. Wait-free, 3 kB a copy.
class TappedQuery final : public ContactQuery {
 public:
  /// @param contacts  outlives this, as does `out`
  /// @param every     >= 1
  /// @param settings  that the contacts are felt with
  /// @param origin_m  of the view, in world axes
  TappedQuery(ContactQuery& contacts, hal::Mailbox<LiveTick>& out, std::uint32_t every,
              const Settings& settings, Vec3d origin_m) noexcept;

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  void show(const Pose& tool, const TickResult& result) noexcept;

  ContactQuery& contacts_;
  hal::Mailbox<LiveTick>& out_;
  std::uint32_t every_;
  std::uint32_t since_ = 0;  ///< the last copy
  Settings settings_;
  Vec3d origin_m_;
  LiveTick tick_;
};

}  // namespace palpate::realtime
