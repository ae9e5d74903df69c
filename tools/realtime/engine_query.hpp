// SPDX-License-Identifier: GPL-3.0-or-later
// The contact engine as the loop's contact query.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/realtime/contact_query.hpp"

namespace palpate::realtime {

/// Every body but the tool stays where it was put.
class EngineQuery final : public ContactQuery {
 public:
  /// @param poses  one a body, body to world; `tool` indexes it. The engine must outlive this.
  EngineQuery(Engine& engine, std::span<const Pose> poses, std::uint32_t tool);

  Status tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept override;

 private:
  Engine& engine_;
  std::vector<Pose> poses_;
  std::uint32_t tool_;
};

}  // namespace palpate::realtime
