// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts at a rate of their own, for a loop that is faster: a server on one thread finds them,
// the loop on another renders their linear model between (rt_core/force/linear_contact.hpp).
//
// Source: Otaduy and Lin, A modular haptic rendering algorithm for stable and transparent 6-DOF
// manipulation, IEEE Trans. Robotics 22(4), 2006.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/clock.hpp"
#include "hal/exchange.hpp"
#include "tools/realtime/budget_clock.hpp"
#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

struct ServerSettings {
  double rate_Hz = 1000;
  QueryTime query_time;       ///< within the period's share
  double period_share = 0.8;  ///< as in LoopSettings
};

/// Answers the newest pose that was asked for. No allocation, lock or log; its only system call is
/// the absolute sleep.
class ContactServer {
 public:
  /// `contacts` outlives this; nobody else may ask it.
  explicit ContactServer(ContactQuery& contacts) : contacts_(contacts) {}

  /// Serves once a period, on a grid as the loop's, until `stop` becomes true.
  void run(const ServerSettings& settings, hal::Clock& clock,
           const std::atomic<bool>& stop) noexcept;

  /// Answers the newest pose; does nothing where none is new.
  void serve(const Budget& budget) noexcept;

  /// Queries that ended after their period; any thread.
  [[nodiscard]] std::uint64_t late() const noexcept {
    return late_.load(std::memory_order_relaxed);
  }

 private:
  friend class ModelledQuery;
  struct Answer {
    Pose tool;
    Status status = Status::ok;
    TickResult result;  ///< of its contacts only the number is of use
  };

  ContactQuery& contacts_;
  hal::Mailbox<Pose> asked_;
  hal::Mailbox<Answer> found_;
  std::atomic<std::uint64_t> late_{0};
};

/// The server's newest answer, carried to where the tool is now. No contacts until the first one.
/// Of `contacts` in the result only the number is of use: they are the server's.
class ModelledQuery final : public ContactQuery {
 public:
  /// @param most_ticks  an answer is used for so many ticks; then answer_too_old
  ModelledQuery(ContactServer& server, std::uint32_t most_ticks)
      : server_(server), most_ticks_(most_ticks) {}

  /// The budget is not used: constant time, wait-free.
  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  ContactServer& server_;
  std::uint32_t most_ticks_;
  std::uint32_t ticks_ = 0;  ///< since the newest answer
  ContactServer::Answer answer_;
};

}  // namespace palpate::realtime
