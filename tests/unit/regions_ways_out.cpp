// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/ways_out.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace palpate::regions {
namespace {

std::vector<double> shares(std::vector<WayOut> ways, std::vector<std::uint32_t> pairs) {
  std::vector<Contact> contacts(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) contacts[i].pair = pairs[i];
  share_by_ways_out(ways, contacts);
  std::vector<double> out;
  for (const Contact& c : contacts) out.push_back(c.share);
  return out;
}

TEST(RegionsWaysOut, the_shortest_way_of_two_pieces_is_felt_whole_and_others_in_proportion) {
  EXPECT_EQ(
      shares({{4, 1, 0, 1, 2}, {9, 1, 1, 1, 3}, {1, 1, 2, 1, 2}, {2, 1, 3, 1, 2}}, {0, 0, 0, 0, 0}),
      (std::vector<double>{0.25, 1, 1, 0.5, 1}));
}

TEST(RegionsWaysOut, ways_that_lead_nearly_as_the_shortest_are_felt_by_the_cosine) {
  std::vector<Contact> contacts(3);
  contacts[0].normal = {0, 0, 1};
  contacts[1].normal = {0.6, 0, 0.8};
  contacts[2].normal = {0, 0.96, -0.28};
  std::vector<WayOut> ways{{1, 1, 0, 1, 2}, {10, 1, 1, 1, 2}, {10, 1, 2, 1, 2}};
  share_by_ways_out(ways, contacts);
  EXPECT_EQ(contacts[0].share, 1);
  EXPECT_DOUBLE_EQ(contacts[1].share, 0.8);
  EXPECT_DOUBLE_EQ(contacts[2].share, 0.1);
}

// Which of two is the shortest may be a matter of rounding.
TEST(RegionsWaysOut, of_ways_as_short_as_each_other_the_one_that_leads_the_same_way_counts) {
  for (const double longer : {1 - 1e-15, 1 + 1e-15}) {
    std::vector<Contact> contacts(4);
    contacts[0].normal = {0, 0, 1};
    contacts[1].normal = {0, 1, 0};
    contacts[2].normal = {0, 0.6, 0.8};
    contacts[3].normal = {0.6, 0.8, 0};
    std::vector<WayOut> ways{
        {1, 1, 0, 1, 2}, {longer, 1, 1, 1, 2}, {10, 1, 2, 1, 2}, {10, 1, 3, 1, 2}};
    share_by_ways_out(ways, contacts);
    EXPECT_NEAR(contacts[0].share, 1, 1e-14);
    EXPECT_NEAR(contacts[1].share, 1, 1e-14);
    EXPECT_NEAR(contacts[2].share, 0.8, 1e-14);
    EXPECT_NEAR(contacts[3].share, 0.8, 1e-14);
  }
}

// The length of a normal is 1 to rounding.
TEST(RegionsWaysOut, none_is_felt_more_than_whole) {
  std::vector<Contact> contacts(2);
  contacts[0].normal = contacts[1].normal = {0.6, 0, 0.8 + 1e-15};
  std::vector<WayOut> ways{{1, 1, 0, 1, 2}, {1, 1, 1, 1, 2}};
  share_by_ways_out(ways, contacts);
  EXPECT_EQ(contacts[0].share, 1);
  EXPECT_EQ(contacts[1].share, 1);
}

TEST(RegionsWaysOut, pieces_of_other_bodies_are_others) {
  EXPECT_EQ(shares({{4, 1, 0, 1, 2}, {1, 1, 1, 1, 2}}, {0, 1}), (std::vector<double>{1, 1}));
}

TEST(RegionsWaysOut, several_pieces_in_a_region_count_by_their_parts) {
  // Contact 0 crosses two pieces, each as contacts 1 and 2 do.
  EXPECT_EQ(
      shares({{4, 0.75, 0, 1, 2}, {8, 0.25, 0, 1, 3}, {1, 1, 1, 1, 2}, {8, 1, 2, 1, 3}}, {0, 0, 0}),
      (std::vector<double>{1 - 0.75 * 0.75, 1, 1}));
}

TEST(RegionsWaysOut, no_way_and_equal_ways_change_nothing) {
  EXPECT_EQ(shares({}, {0, 0}), (std::vector<double>{1, 1}));
  EXPECT_EQ(shares({{1e-300, 1, 1, 0, 0}, {1e-300, 1, 0, 0, 0}}, {0, 0}),
            (std::vector<double>{1, 1}));
}

}  // namespace
}  // namespace palpate::regions
