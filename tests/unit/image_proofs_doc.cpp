// SPDX-License-Identifier: GPL-3.0-or-later
// docs/FORMAT.md, Sec. 11, against what verify() proves.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "../support/tiny_image.hpp"
#include "host_bake/bake.hpp"

namespace palpate::bake {
namespace {

/// Second cells of the rows `| Gn | ... |`.
std::vector<std::string> listed_invariants() {
  std::vector<std::string> found;
  std::ifstream in(PALPATE_DOCS "/FORMAT.md");
  for (std::string line; std::getline(in, line);) {
    const std::string start = "| G" + std::to_string(found.size() + 1) + " | ";
    if (!line.starts_with(start)) continue;
    found.push_back(line.substr(start.size(), line.find(" |", start.size()) - start.size()));
  }
  return found;
}

TEST(FormatPage, Lists_the_invariants_that_are_proved) {
  const auto bytes = test::seal(test::parts_of({test::box_part({0, 0, 0}, {0.5f, 0.5f, 0.5f})}));
  ImageView image;
  ASSERT_EQ(validate(bytes, image), Status::ok);
  std::vector<std::string> proved;
  for (const Proof& proof : verify(image)) proved.push_back(proof.invariant);
  EXPECT_EQ(listed_invariants(), proved);
}

}  // namespace
}  // namespace palpate::bake
