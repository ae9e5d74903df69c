// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "rt_core/regions/ways_out.hpp"

namespace palpate::regions {
namespace {

Contact contact_of(std::uint32_t pair, std::uint32_t piece_a, std::uint32_t piece_b) {
  Contact c;
  c.pair = pair;
  c.piece_a = piece_a;
  c.piece_b = piece_b;
  return c;
}

TEST(RegionsWaysOut, the_shortest_way_of_two_pieces_is_felt_whole_and_others_in_proportion) {
  std::vector<Contact> contacts{contact_of(0, 1, 2), contact_of(0, 1, 3), contact_of(0, 1, 2),
                                contact_of(1, 1, 2), contact_of(0, 1, 2), contact_of(0, 7, 2)};
  std::vector<WayOut> ways{{4, 0}, {9, 1}, {1, 2}, {5, 3}, {2, 4}};
  share_by_ways_out(ways, contacts);
  EXPECT_EQ(contacts[0].share, 0.25);
  EXPECT_EQ(contacts[1].share, 1);
  EXPECT_EQ(contacts[2].share, 1);
  EXPECT_EQ(contacts[3].share, 1);
  EXPECT_EQ(contacts[4].share, 0.5);
  EXPECT_EQ(contacts[5].share, 1);  // does not cross
}

TEST(RegionsWaysOut, no_way_and_equal_ways_change_nothing) {
  std::vector<Contact> contacts(3);
  share_by_ways_out({}, contacts);
  std::vector<WayOut> ways{{1e-300, 2}, {1e-300, 0}, {1e-300, 1}};
  share_by_ways_out(ways, contacts);
  for (const Contact& c : contacts) EXPECT_EQ(c.share, 1);
}

}  // namespace
}  // namespace palpate::regions
