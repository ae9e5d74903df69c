// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {
namespace {

Transform in_float(const Mat3d& r, Vec3d translation, double scale) noexcept {
  const auto f = [](double v) noexcept { return static_cast<float>(v); };
  return {{f(r.row0.x), f(r.row0.y), f(r.row0.z), f(r.row1.x), f(r.row1.y), f(r.row1.z),
           f(r.row2.x), f(r.row2.y), f(r.row2.z)},
          {f(translation.x), f(translation.y), f(translation.z)},
          f(scale)};
}

}  // namespace

PairFrame frame_of(const levels::PairState& pair) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d t = pair.b_in_a.translation;
  const Mat3d back = transpose(r);
  PairFrame frame;
  frame.a = pair.image_a;
  frame.b = pair.image_b;
  frame.b_to_a = in_float(r, (1.0 / pair.scale_a) * t, pair.scale_b / pair.scale_a);
  frame.a_to_b = in_float(back, (1.0 / pair.scale_b) * -(back * t), pair.scale_a / pair.scale_b);
  frame.scale2_a = static_cast<float>(pair.scale_a * pair.scale_a);
  frame.scale2_b = static_cast<float>(pair.scale_b * pair.scale_b);
  return frame;
}

}  // namespace palpate::regions
