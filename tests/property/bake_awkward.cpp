// SPDX-License-Identifier: GPL-3.0-or-later
// Small awkward meshes: noise, slivers, coplanar regions, needles, touching components, holes. Each
// bakes to an image whose invariants all hold, or is refused by name before.
#include <gtest/gtest.h>

#include <string>

#include "../unit/simplify_random.hpp"
#include "host_bake/bake.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/pack/aligned.hpp"

namespace palpate::test {
namespace {

#ifdef PALPATE_LONG
constexpr std::uint32_t kFirst = 1000, kMeshes = 1000;
#else
constexpr std::uint32_t kFirst = 0, kMeshes = 40;
#endif

std::string wrong_in(const bake::Mesh& mesh, const bake::CheckReport& check) {
  bake::BakeReport report;
  bake::BakeOptions options;
  options.engine = bake::ForEngine::both;
  options.stop.stop_resolution = 1.5;  // small meshes are coarse: levels of detail all the same
  const bake::AlignedCopy image(bake::bake(mesh, check, options, {}, report));
  ImageView view;
  if (validate(image.bytes(), view) != Status::ok) return "not valid";
  std::string wrong;
  for (const bake::Proof& proof : bake::verify(view)) {
    if (!proof.holds) wrong += proof.invariant + ": " + proof.found + "\n";
  }
  return wrong;
}

TEST(BakeAwkward, every_invariant_holds) {
  std::uint32_t refused = 0;
  for (std::uint32_t seed = kFirst; seed < kFirst + kMeshes; ++seed) {
    const bake::Mesh mesh = awkward_mesh(seed);
    const bake::CheckReport check = bake::check(mesh);
    if (!check.bakeable()) {
      ++refused;
      EXPECT_THROW(bake::require_bakeable(check, "mesh", false), bake::InputRefused);
      continue;
    }
    EXPECT_EQ(wrong_in(mesh, check), "") << "seed " << seed;
  }
  EXPECT_LT(refused, kMeshes / 10);
}

}  // namespace
}  // namespace palpate::test
