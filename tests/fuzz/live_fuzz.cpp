// SPDX-License-Identifier: GPL-3.0-or-later
// Hostile messages from a page: whatever is understood is finite, near enough, a rotation, and says
// the same when it is written again.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tools/live/messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const auto lead = live::parse_lead(std::as_bytes(std::span(data, size)));
  if (!lead) return 0;
  if (size != (lead->held ? live::kLeadBytes : live::kLetGoBytes)) __builtin_trap();
  const Vec3d& p = lead->to.position_m;
  const Quat& q = lead->to.orientation;
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(std::abs(length - 1) < 1e-9)) __builtin_trap();
  for (const double value : {p.x, p.y, p.z}) {
    if (!(std::abs(value) <= live::kFarthest_m)) __builtin_trap();
  }
  const auto again = live::parse_lead(live::encode_lead(*lead));
  if (!again || again->held != lead->held || !(again->to.position_m == p)) __builtin_trap();
  return 0;
}
