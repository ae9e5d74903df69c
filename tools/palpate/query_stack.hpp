// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene asks of its contacts, one query upon another; what it does not ask for is not there.
#pragma once

#include <optional>

#include "config/scene.hpp"
#include "tools/realtime/contact_server.hpp"
#include "tools/realtime/coupled_query.hpp"
#include "tools/realtime/damped_query.hpp"
#include "tools/realtime/engine_query.hpp"
#include "tools/realtime/friction_query.hpp"
#include "tools/realtime/steady_query.hpp"
#include "tools/realtime/tapped_query.hpp"

namespace palpate::cli {

/// What a live view is shown of the contacts.
struct ContactTap {
  hal::Mailbox<realtime::LiveTick>* out = nullptr;  ///< null: nothing
  Vec3d origin_m{};                                 ///< of the view, in world axes
};

/// engine -> view -> friction -> steadying -> (another thread) -> coupling or damping.
class QueryStack {
 public:
  /// @param engine   outlives this
  /// @param poses    [bodies]
  /// @param rate_Hz  of the loop that asks top()
  QueryStack(const config::Scene& scene, Engine& engine, std::span<const Pose> poses,
             double rate_Hz, const ContactTap& tap = {});
  QueryStack(const QueryStack&) = delete;
  QueryStack& operator=(const QueryStack&) = delete;
  QueryStack(QueryStack&&) = delete;
  QueryStack& operator=(QueryStack&&) = delete;
  ~QueryStack() = default;

  [[nodiscard]] realtime::ContactQuery& top() { return *top_; }
  /// To be run on a thread of its own while top() is asked; null where top() asks the engine
  /// itself.
  [[nodiscard]] realtime::ContactServer* server() { return server_ ? &*server_ : nullptr; }

 private:
  realtime::EngineQuery engine_;
  std::optional<realtime::TappedQuery> tapped_;
  std::optional<realtime::FrictionQuery> friction_;
  std::optional<realtime::SteadyQuery> steady_;
  std::optional<realtime::ContactServer> server_;
  std::optional<realtime::ModelledQuery> modelled_;
  std::optional<realtime::CoupledQuery> coupled_;
  std::optional<realtime::DampedQuery> damped_;
  realtime::ContactQuery* top_ = &engine_;
};

}  // namespace palpate::cli
