// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/engine_query.hpp"

namespace palpate::realtime {

EngineQuery::EngineQuery(Engine& engine, std::span<const Pose> poses, std::uint32_t tool)
    : engine_(engine), poses_(poses.begin(), poses.end()), tool_(tool) {}

Status EngineQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  poses_[tool_] = tool;
  return palpate::tick(engine_, poses_, budget, out);
}

}  // namespace palpate::realtime
