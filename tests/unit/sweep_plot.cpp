// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tools/plot/svg.hpp"

namespace palpate::plot {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(SvgPlot, Points_and_lines_are_drawn_where_they_can_be) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Panel> panels = {{"a & b",
                                      {"x", true},
                                      {"y", false},
                                      {{"one", Mark::point, {{1, 2}, {10, 3}, {0, 4}, {5, none}}},
                                       {"two", Mark::line, {{1, 2}, {100, 5}}}}}};
  const std::string svg = to_svg(panels);
  EXPECT_EQ(count(svg, "<circle"), 2u);  // 0 has no place on a log axis
  EXPECT_EQ(count(svg, "stroke-width"), 1u);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(count(svg, "<svg"), 1u);
  EXPECT_EQ(count(svg, "</svg>"), 1u);
}

TEST(SvgPlot, Nothing_to_draw_and_a_single_value_have_axes_all_the_same) {
  for (const bool log : {false, true}) {
    const std::vector<Panel> panels = {
        {"", {"x", log}, {"y", log}, {}},
        {"", {"x", log}, {"y", log}, {{"", Mark::point, {{7, 7}, {7, 7}}}}}};
    const std::string svg = to_svg(panels);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_GE(count(svg, "class='g'"), 8u);
  }
}

}  // namespace
}  // namespace palpate::plot
