// SPDX-License-Identifier: GPL-3.0-or-later
// What the loop asks once a tick. The engine answers it in a run; tests answer it with a wall.
#pragma once

#include "rt_core/palpate_rt.hpp"

namespace palpate::realtime {

class ContactQuery {
 public:
  virtual ~ContactQuery() = default;
  ContactQuery() = default;
  ContactQuery(const ContactQuery&) = delete;
  ContactQuery& operator=(const ContactQuery&) = delete;
  ContactQuery(ContactQuery&&) = delete;
  ContactQuery& operator=(ContactQuery&&) = delete;

  /// As palpate::tick(), for a pose of the tool. Bounded in time by the budget; no allocation, lock
  /// or system call.
  virtual Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept = 0;
};

}  // namespace palpate::realtime
