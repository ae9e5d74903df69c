// SPDX-License-Identifier: Apache-2.0
// What goes first under a budget, of intervals that are open.
#include <gtest/gtest.h>

#include "rt_core/regions/work.hpp"

namespace palpate::test {
namespace {

using regions::Active;

constexpr float kDelta = 0.1f;

/// A query of one pair of bodies.
struct Order {
  explicit Order(const regions::Demand& demand) : work(memory, demand, meter) {
    pair.delta = static_cast<double>(kDelta);
    memory.pairs = {&pair, 1};
  }
  /// Of an interval of so many delta that costs so many times the mean.
  float worth(float width, float weight) const {
    return work.worth({.width = width * kDelta, .weight = weight, .way = {}});
  }
  levels::PairState pair;
  regions::QueryMemory memory;
  Meter meter{{.units = 1000}, {}};
  regions::Work work;
};

TEST(RegionOrder, the_widest_goes_first_whatever_it_costs) {
  const Order order({.limited = true});
  EXPECT_GT(order.worth(0.6f, 1), order.worth(0.5f, 0.1f));
  EXPECT_GT(order.worth(0.6f, 10), order.worth(0.5f, 1));
  EXPECT_GE(order.worth(0.21f, 10), order.worth(0.19f, 0.01f));
}

TEST(RegionOrder, of_narrow_intervals_what_is_cheap_to_prove_goes_first) {
  const Order order({.limited = true});
  EXPECT_GT(order.worth(0.05f, 0.5f), order.worth(0.08f, 1));
  EXPECT_GT(order.worth(0.08f, 1), order.worth(0.05f, 1));
  EXPECT_GT(order.worth(0.05f, 1), order.worth(0.1f, 4));
}

TEST(RegionOrder, with_a_tolerance_all_that_is_open_counts_by_its_share) {
  const Order order({.tolerance_m = 1, .limited = true});
  EXPECT_GT(order.worth(0.5f, 0.5f), order.worth(0.8f, 1));
}

}  // namespace
}  // namespace palpate::test
