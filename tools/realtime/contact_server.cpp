// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/contact_server.hpp"

#include <algorithm>

#include "rt_core/force/linear_contact.hpp"
#include "tools/realtime/budget_clock.hpp"

namespace palpate::realtime {

void ContactServer::run(const ServerSettings& settings, hal::Clock& clock,
                        const std::atomic<bool>& stop) noexcept {
  const std::uint64_t period_ns = nanoseconds(1 / settings.rate_Hz);
  const std::uint64_t share_ns = nanoseconds(settings.period_share / settings.rate_Hz);
  std::uint64_t due_ns = clock.now_ns();
  while (!stop.load(std::memory_order_relaxed)) {
    clock.sleep_until(due_ns);
    serve(budget_between(clock, clock.now_ns(), due_ns + share_ns, settings.query_time));
    const std::uint64_t passed = (clock.now_ns() - due_ns) / period_ns;
    if (passed > 0) late_.fetch_add(1, std::memory_order_relaxed);
    due_ns += (1 + passed) * period_ns;
  }
}

void ContactServer::serve(const Budget& budget) noexcept {
  Answer answer;
  if (!asked_.read(answer.tool)) return;
  answer.status = contacts_.tick(answer.tool, budget, answer.result);
  found_.write(answer);
}

Status ModelledQuery::tick(const Pose& tool, const Budget&, TickResult& out) noexcept {
  server_.asked_.write(tool);
  ticks_ = server_.found_.read(answer_) ? 0 : ticks_ + 1;
  if (ticks_ > most_ticks_) return Status::answer_too_old;
  if (answer_.status != Status::ok) return answer_.status;
  out = answer_.result;
  out.wrench =
      force::predicted({answer_.tool, answer_.result.wrench, answer_.result.stiffness}, tool);
  return Status::ok;
}

}  // namespace palpate::realtime
