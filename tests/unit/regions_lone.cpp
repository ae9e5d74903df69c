// SPDX-License-Identifier: Apache-2.0
// How alone a contact is in its direction.
#include "rt_core/regions/lone.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <vector>

namespace palpate::test {
namespace {

using image::RegionTriangle;
using regions::Witness;

constexpr float kDelta = 0.1f;
constexpr float kGap = 0.05f;

RegionTriangle triangle(Vec3f p, Vec3f q, Vec3f r) {
  RegionTriangle out{};
  const float corners[] = {p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z};
  std::copy(std::begin(corners), std::end(corners), out.corners);
  return out;
}

/// A floor that faces up, and a wall to the left of it.
const RegionTriangle kRoom[] = {triangle({-4, -4, 0}, {4, -4, 0}, {0, 8, 0}),
                                triangle({0, -4, -4}, {0, 8, 0}, {0, -4, 4})};
constexpr std::uint32_t kFloor = 0;
constexpr std::uint32_t kWall = 1;

/// Small triangles of a first body, each a region, about a room.
struct Touching {
  void add(Vec3f at, std::uint32_t of_room, float distance) {
    const auto i = static_cast<std::uint32_t>(triangles.size());
    const float s = 1e-3f;
    triangles.push_back(triangle(at, at + Vec3f{0, s, 0}, at + Vec3f{s, 0, 0}));
    triangles.back().region = i;
    witnesses.push_back({i, of_room, distance});
    active.push_back({.way = {}, .state = i, .region = i, .pair = 0});
  }
  void over_floor(float gap = kGap) {
    add({1 + 0.05f * static_cast<float>(triangles.size()), 0.5f, gap}, kFloor, gap);
  }
  void beside_wall() { add({kGap, 0.5f, 1}, kWall, kGap); }

  /// How alone each one is.
  std::vector<float> lone() {
    a.region_triangles = triangles;
    b.region_triangles = kRoom;
    absence.assign(triangles.size(), 0);
    pair.image_a = &a;
    pair.image_b = &b;
    pair.scale_a = pair.scale_b = 1;
    pair.delta = static_cast<double>(kDelta);
    pair.rotation_a = pair.b_in_a.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    frame = regions::frame_of(pair);
    memory.kernels = &regions::best_kernels();
    memory.search = scratch.get();
    memory.pairs = {&pair, 1};
    memory.frames = {&frame, 1};
    memory.witnesses = witnesses;
    memory.active = active;
    memory.crowd.absence = absence;
    Meter meter({.units = 1000}, {});
    regions::Work work(memory, {.limited = true}, meter);
    work.count = static_cast<std::uint32_t>(active.size());
    regions::tell_lone(work);
    units = work.pace.used();
    std::vector<float> out;
    for (const regions::Active& item : active) out.push_back(item.lone);
    return out;
  }

  std::vector<RegionTriangle> triangles;
  std::vector<Witness> witnesses;
  std::vector<regions::Active> active;
  std::vector<float> absence;
  std::unique_ptr<regions::SearchScratch> scratch = std::make_unique<regions::SearchScratch>();
  ImageView a, b;
  levels::PairState pair;
  regions::PairFrame frame;
  regions::QueryMemory memory;
  std::uint64_t units = 0;
};

TEST(RegionsLone, one_at_a_wall_is_as_alone_as_many_on_a_floor_are_together) {
  constexpr std::uint32_t kMany = 20;
  Touching s;
  for (std::uint32_t i = 0; i < kMany; ++i) s.over_floor();
  s.beside_wall();
  const std::vector<float> lone = s.lone();
  for (std::uint32_t i = 0; i < kMany; ++i) EXPECT_NEAR(lone[i], lone[0], 1e-4);
  EXPECT_NEAR(lone.back() / lone[0], kMany, 1e-3);
  EXPECT_NEAR(std::accumulate(lone.begin(), lone.end(), 0.0f) / (kMany + 1), 1, 1e-4);
  EXPECT_EQ(s.units, 2 * regions::kBatchUnits);
}

TEST(RegionsLone, what_is_shallow_takes_little_from_others) {
  Touching deep, shallow;
  for (Touching* s : {&deep, &shallow}) {
    s->over_floor();
    s->beside_wall();
  }
  deep.over_floor(0.1f * kDelta);
  shallow.over_floor(0.99f * kDelta);
  const float beside_deep = deep.lone()[0] / deep.lone()[1];
  const float beside_shallow = shallow.lone()[0] / shallow.lone()[1];
  EXPECT_LT(beside_deep, 0.3f);
  EXPECT_GT(beside_shallow, 0.7f);
}

TEST(RegionsLone, what_is_not_felt_is_not_counted) {
  Touching s;
  s.over_floor();
  s.over_floor(1.5f * kDelta);
  EXPECT_EQ(s.lone(), (std::vector<float>{1, 1}));
  Touching none;
  none.over_floor(1.5f * kDelta);
  EXPECT_EQ(none.lone(), std::vector<float>{1});
  EXPECT_EQ(none.units, 0u);
}

/// A pair that crosses lies no way, and is alone.
TEST(RegionsLone, what_crosses_is_alone) {
  Touching s;
  for (int i = 0; i < 8; ++i) s.over_floor();
  s.add({1, 0.5f, 0}, kFloor, 0);
  s.triangles.back().corners[2] = -1e-3f;
  s.triangles.back().corners[5] = 1e-3f;
  const std::vector<float> lone = s.lone();
  EXPECT_EQ(s.witnesses.back().distance, 0);
  EXPECT_GT(lone.back(), 2 * lone[0]);
}

TEST(RegionsLone, after_a_jump_one_at_a_wall_goes_before_deeper_ones_on_a_floor) {
  Touching s;
  for (int i = 0; i < 8; ++i) s.over_floor(0.7f * kGap);
  s.beside_wall();
  static_cast<void>(s.lone());
  Meter meter({.units = 1000}, {});
  regions::Work work(s.memory, {.limited = true}, meter);
  work.count = static_cast<std::uint32_t>(s.active.size());
  work.anew = true;
  for (const bool told : {true, false}) {
    for (regions::Active& item : s.active) {
      item.climbed = true;
      item.rest = work.upper_of(item) - 0.3f * kDelta;
      if (!told) item.lone = 1;
    }
    work.widen_all();
    EXPECT_EQ(s.active.back().urgency > s.active.front().urgency, told);
  }
}

}  // namespace
}  // namespace palpate::test
