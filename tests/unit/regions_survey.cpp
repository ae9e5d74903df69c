// SPDX-License-Identifier: GPL-3.0-or-later
// What a survey measures and what it passes over; what is watched for between surveys.
#include "rt_core/regions/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/regions/look.hpp"
#include "rt_core/regions/watch.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

const BakedBody& ball() {
  static const BakedBody body(bumpy_ball(40, 60, 1), bake::ForEngine::regions);
  return body;
}

constexpr std::uint64_t kPlenty = 100000;

/// Two balls so far from centre to centre, the first one of another size; nothing is known.
struct TwoBalls {
  explicit TwoBalls(double between, double size = 1) {
    const ImageView& view = ball().view;
    const std::size_t count = view.regions.size();
    states.resize(count);
    kept.resize(count);
    witnesses.resize(count);
    queue.resize(count);
    turns.resize(count);
    absence.assign(count, 0);
    pair.image_a = pair.image_b = &view;
    pair.scale_a = size;
    pair.delta = 0.3;
    pair.rotation_a = pair.b_in_a.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pair.b_in_a.translation = {between, 0, 0};
    frame = regions::frame_of(pair);
    for (std::uint32_t i = 0; i < count; ++i) {
      active.push_back({.width = 0.3f, .way = {}, .state = i, .region = i, .pair = 0});
    }
    memory.kernels = &regions::best_kernels();
    memory.search = scratch.get();
    memory.pairs = {&pair, 1};
    memory.frames = {&frame, 1};
    memory.states = states;
    memory.kept = kept;
    memory.witnesses = witnesses;
    memory.active = active;
    memory.queue = queue;
    memory.turns = turns;
    memory.crowd.absence = absence;
  }

  /// @return work units
  std::uint64_t survey(std::uint64_t units) {
    Meter meter({.units = units}, {});
    regions::Work work(memory, {.limited = true}, meter);
    work.count = static_cast<std::uint32_t>(active.size());
    work.anew = work.swept = true;
    seen = regions::survey(work, 1);
    return work.pace.used();
  }

  /// In a tick that goes on from the one before.
  /// @return work units
  std::uint64_t watch(std::uint64_t units) {
    for (regions::Active& item : active) item.climbed = false;
    Meter meter({.units = units}, {});
    regions::Work work(memory, {.limited = true}, meter);
    work.count = static_cast<std::uint32_t>(active.size());
    regions::watch(work);
    return work.pace.used();
  }

  /// Of all that a region has looked at spread over it, all of it measured.
  regions::Witness nearest_of_looks(std::uint32_t region) {
    Meter meter({}, {});
    Pace pace(meter);
    regions::Witness nearest;
    for (std::uint32_t look = 0; look < kept[region].seeds.dives; ++look) {
      regions::Looks looks;
      regions::look_over(frame, region, look, 1, looks);
      regions::look_from(*memory.kernels, frame, looks);
      scratch->batch_a[0] = looks.a[0];
      scratch->batch_b[0] = looks.b[0];
      float distances[regions::kBatch];
      regions::measure(*memory.kernels, frame, *scratch, pace, 1, distances);
      if (!nearest.nearer_than(distances[0])) nearest = {looks.a[0], looks.b[0], distances[0]};
    }
    return nearest;
  }

  std::vector<regions::RegionState> states;
  std::vector<regions::RegionPairs> kept;
  std::vector<regions::Witness> witnesses;
  std::vector<regions::Active> active;
  std::vector<std::uint32_t> queue;
  std::vector<std::uint64_t> turns;
  std::vector<float> absence;
  std::unique_ptr<regions::SearchScratch> scratch = std::make_unique<regions::SearchScratch>();
  levels::PairState pair;
  regions::PairFrame frame;
  regions::QueryMemory memory;
  bool seen = false;
};

TEST(RegionsSurvey, what_it_does_not_measure_is_not_nearer) {
  for (const double between : {1.9, 2.05, 2.3}) {
    TwoBalls s(between);
    static_cast<void>(s.survey(kPlenty));
    ASSERT_TRUE(s.seen);
    for (std::uint32_t region = 0; region < s.active.size(); ++region) {
      ASSERT_GT(s.kept[region].seeds.dives, 0u);
      ASSERT_TRUE(s.witnesses[region].known());
      EXPECT_LE(s.witnesses[region].distance, s.nearest_of_looks(region).distance) << region;
    }
  }
}

/// One in the other, so that faces lie above faces. But for those beside the nearest, each look
/// would take half a unit more if what it meets were measured.
TEST(RegionsSurvey, little_of_what_looks_meet_is_measured) {
  TwoBalls s(0, 0.95);
  const auto used = static_cast<double>(s.survey(kPlenty));
  double spread = 0;
  for (const regions::RegionPairs& of_region : s.kept) spread += of_region.seeds.dives;
  constexpr double kEach = static_cast<double>(regions::kBatchUnits) / regions::kBatch;
  EXPECT_LT(used, spread * (1.0 / regions::kLooksPerUnit + kEach));
}

/// Regions that are seen.
std::size_t seen_by(const TwoBalls& s) {
  return static_cast<std::size_t>(std::count_if(
      s.kept.begin(), s.kept.end(),
      [](const regions::RegionPairs& of_region) { return of_region.seeds.dives > 0; }));
}

/// With sixteen looks of each that may be felt it would be some 120.
TEST(RegionsSurvey, more_regions_are_seen_where_few_are_felt) {
  TwoBalls s(1.8);
  static_cast<void>(s.survey(1000));
  EXPECT_GT(seen_by(s), 160u);
}

/// As little is left there for each, and each has all of the looks there are.
TEST(RegionsSurvey, regions_are_seen_as_well_as_ever_where_all_are_felt) {
  TwoBalls s(0, 0.95);
  static_cast<void>(s.survey(1000));
  EXPECT_LT(seen_by(s), 160u);
  for (std::uint32_t region = 0; region < s.kept.size(); ++region) {
    const std::uint32_t looks = s.kept[region].seeds.dives;
    EXPECT_TRUE(looks == 0 || looks == 16) << region << " has " << looks;
  }
}

TEST(RegionsSurvey, ends_soon_after_its_units_do) {
  for (const std::uint64_t units : {64u, 200u, 500u}) {
    TwoBalls s(2.05);
    EXPECT_LE(s.survey(units), units + 2 * regions::kBatchUnits) << units;
  }
}

TEST(RegionsWatch, what_has_come_near_is_felt_before_it_is_searched) {
  TwoBalls surveyed(2.05);
  static_cast<void>(surveyed.survey(kPlenty));
  TwoBalls watched(2.05);
  constexpr int kTicks = 200;
  for (int tick = 0; tick < kTicks; ++tick) static_cast<void>(watched.watch(300));
  const auto delta = static_cast<float>(watched.pair.delta);
  int felt = 0;
  for (std::uint32_t region = 0; region < watched.active.size(); ++region) {
    const regions::Witness& seen = surveyed.witnesses[region];
    if (!seen.nearer_than(delta)) continue;
    ++felt;
    EXPECT_LE(watched.witnesses[region].distance, seen.distance + 0.05f * delta) << region;
  }
  EXPECT_GT(felt, 0);
}

TEST(RegionsWatch, what_is_proved_to_be_far_takes_nothing) {
  TwoBalls s(2.05);
  for (regions::Active& item : s.active) {
    item.rest = static_cast<float>(s.pair.delta);
    item.width = 0;
  }
  EXPECT_EQ(s.watch(1000), 0u);
  for (const regions::Witness& witness : s.witnesses) EXPECT_FALSE(witness.known());
}

TEST(RegionsWatch, leaves_most_of_a_tick_to_searches) {
  for (const std::uint64_t units : {200u, 500u, 2000u}) {
    TwoBalls s(2.05);
    for (int tick = 0; tick < 10; ++tick) {
      EXPECT_LE(s.watch(units), units / 2 + regions::kMaxClimb * 10) << units;
    }
  }
}

}  // namespace
}  // namespace palpate::test
