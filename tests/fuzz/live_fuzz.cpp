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
  const auto pose = live::parse_lead(std::as_bytes(std::span(data, size)));
  if (!pose) return 0;
  const Vec3d& p = pose->position_m;
  const Quat& q = pose->orientation;
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (size != live::kLeadBytes || !(std::abs(length - 1) < 1e-9)) __builtin_trap();
  for (const double value : {p.x, p.y, p.z}) {
    if (!(std::abs(value) <= live::kFarthest_m)) __builtin_trap();
  }
  const auto again = live::parse_lead(live::encode_lead(*pose));
  if (!again || !(again->position_m == p)) __builtin_trap();
  return 0;
}
