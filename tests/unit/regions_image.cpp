// SPDX-License-Identifier: GPL-3.0-or-later
// The region sections of an image: what the baker makes, and what validate() refuses of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/regions/region_tree.hpp"
#include "rt_core/image/triangle_normal.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/components.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/shapes.hpp"
#include "tests/unit/mesh_support.hpp"

namespace palpate::test {
namespace {

using image::SectionId;

const BakedBody& bumpy() {
  static const BakedBody body(bumpy_ball(14, 20, 1), bake::ForEngine::regions);
  return body;
}

/// A copy of a good image that can be damaged and signed again.
class Damaged {
 public:
  explicit Damaged(const BakedBody& body = bumpy()) : bytes_(body.bytes->size) {
    std::memcpy(bytes_.data.get(), body.bytes->data.get(), bytes_.size);
  }
  template <class T>
  T* section(SectionId id) {
    const image::Section& s = header().sections[static_cast<std::size_t>(id)];
    return reinterpret_cast<T*>(bytes_.data.get() + s.offset);
  }
  image::Header& header() { return *reinterpret_cast<image::Header*>(bytes_.data.get()); }
  image::RegionNode* nodes() { return section<image::RegionNode>(SectionId::region_nodes); }
  image::RegionTriangle* triangles() {
    return section<image::RegionTriangle>(SectionId::region_triangles);
  }
  image::ProximityGrid& grid() { return *section<image::ProximityGrid>(SectionId::proximity_grid); }
  std::uint32_t* bricks() { return section<std::uint32_t>(SectionId::proximity_bricks); }
  std::uint32_t* cells() { return section<std::uint32_t>(SectionId::proximity_cells); }
  image::Region* regions() { return section<image::Region>(SectionId::regions); }

  Status check(ImageView& out) {
    const auto hash = content_sha256(bytes_.span());
    std::memcpy(header().content_sha256, hash.data(), hash.size());
    return validate(bytes_.span(), out);
  }

 private:
  AlignedMemory bytes_;
};

struct Damage {
  const char* what;
  Status refused_as;
  std::function<void(Damaged&)> done;
};

TEST(RegionImage, Damage_of_every_kind_is_refused_by_name) {
  ImageView view;
  ASSERT_EQ(Damaged().check(view), Status::ok);
  const std::vector<Damage> all = {
      {"no root", Status::image_bad_tree, [](Damaged& d) { d.nodes()[0].parent = 0; }},
      {"root is a leaf", Status::image_bad_tree, [](Damaged& d) { d.nodes()[0].leaf = 1; }},
      {"leaf is no flag", Status::image_bad_tree, [](Damaged& d) { d.nodes()[1].leaf = 2; }},
      {"no child", Status::image_bad_tree, [](Damaged& d) { d.nodes()[0].children = 0; }},
      {"many children", Status::image_bad_tree, [](Damaged& d) { d.nodes()[0].children = 17; }},
      {"shifted run", Status::image_bad_tree, [](Damaged& d) { ++d.nodes()[0].first; }},
      {"other parent", Status::image_bad_tree, [](Damaged& d) { d.nodes()[1].parent = 1; }},
      {"other region", Status::image_bad_tree, [](Damaged& d) { d.regions()[0].slot += 1; }},
      {"no such region", Status::image_bad_tree, [](Damaged& d) { d.regions()[0].parent = ~0u; }},
      {"regions not counted", Status::image_bad_tree, [](Damaged& d) { ++d.nodes()[0].regions; }},
      {"regions not in order", Status::image_bad_tree,
       [](Damaged& d) { d.nodes()[1].first_region = 1; }},
      {"infinite box", Status::image_bad_float,
       [](Damaged& d) { d.nodes()[0].half[1][0] = std::numeric_limits<float>::infinity(); }},
      {"box without number", Status::image_bad_float,
       [](Damaged& d) { d.nodes()[0].centre[1][0] = std::numeric_limits<float>::quiet_NaN(); }},
      {"crooked axes", Status::image_bad_float, [](Damaged& d) { d.nodes()[0].axes[0][0] += 1; }},
      {"box too small", Status::image_bad_tree,
       [](Damaged& d) { d.nodes()[0].half[0][1] *= 0.9f; }},
      {"corner elsewhere", Status::image_bad_tree,
       [](Damaged& d) { d.triangles()[0].corners[0] *= 0.9f; }},
      {"corner far away", Status::image_bad_float,
       [](Damaged& d) { d.triangles()[0].corners[0] = 1.4f; }},
      {"reach too short", Status::image_bad_float,
       [](Damaged& d) { d.regions()[0].reach *= 0.5f; }},
      {"no such neighbour", Status::image_bad_index,
       [](Damaged& d) { d.triangles()[0].neighbours[0] = d.header().source_triangles; }},
      {"own neighbour", Status::image_bad_index,
       [](Damaged& d) { d.triangles()[0].neighbours[0] = 0; }},
      {"one-sided neighbour", Status::image_bad_index,
       [](Damaged& d) { d.triangles()[0].neighbours[0] = image::kNone; }},
      {"no such piece", Status::image_bad_index, [](Damaged& d) { d.triangles()[0].piece = ~0u; }},
      {"piece of no surface", Status::image_bad_index,
       [](Damaged& d) { d.triangles()[0].piece = 0; }},
      {"no such source", Status::image_bad_index,
       [](Damaged& d) { d.triangles()[0].source = d.header().source_triangles; }},
      {"other region of a triangle", Status::image_bad_index,
       [](Damaged& d) { ++d.triangles()[0].region; }},
      {"cells of no size", Status::image_bad_float, [](Damaged& d) { d.grid().cell = 0; }},
      {"grid nowhere", Status::image_bad_float,
       [](Damaged& d) { d.grid().origin[1] = std::numeric_limits<float>::quiet_NaN(); }},
      {"bricks not counted", Status::image_bad_section, [](Damaged& d) { ++d.grid().bricks[2]; }},
      {"endless bricks", Status::image_bad_section,
       [](Damaged& d) { d.grid().bricks[0] = 1u << 31; }},
      {"reserved field of the grid used", Status::image_bad_section,
       [](Damaged& d) { d.grid().reserved = 1; }},
      {"cell of no triangle", Status::image_bad_index,
       [](Damaged& d) { d.cells()[5] = d.header().source_triangles; }},
      {"brick of no triangle", Status::image_bad_index,
       [](Damaged& d) { d.bricks()[0] = image::kCoarseBrick | d.header().source_triangles; }},
      {"brick of no cells", Status::image_bad_index, [](Damaged& d) { d.bricks()[0] = 77777; }},
      {"reserved field used", Status::image_bad_section,
       [](Damaged& d) { d.nodes()[3].reserved[2] = 1; }},
  };
  for (const Damage& damage : all) {
    Damaged image;
    damage.done(image);
    EXPECT_EQ(image.check(view), damage.refused_as) << damage.what;
  }
}

/// Three balls: the first triangles of their components lead from one to the next.
const BakedBody& apart() {
  static const BakedBody body = [] {
    bake::Mesh mesh;
    for (const double x : {0.0, 3.0, 6.0}) {
      bake::Mesh one = ball(4, 6, 1);
      for (bake::Point& p : one.points) p[0] += x;
      mesh = bake::testing::together(mesh, one);
    }
    return BakedBody(std::move(mesh), bake::ForEngine::regions);
  }();
  return body;
}

TEST(RegionImage, Components_are_told_apart) {
  const ImageView& view = apart().view;
  const auto triangles = static_cast<std::uint32_t>(view.region_triangles.size());
  const std::uint32_t each = triangles / 3;
  std::uint32_t components = 0;
  std::uint32_t members = 0;
  ASSERT_TRUE(tells_components(view));
  for (std::uint32_t first = 0; first != image::kNone; first = next_component(view, first)) {
    const std::uint32_t of_source = view.region_triangles[first].source / each;
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const bool of_it = view.region_triangles[i].source / each == of_source;
      ASSERT_EQ(first_of_component(view, i) == first, of_it);
      members += of_it ? 1 : 0;
    }
    ++components;
  }
  EXPECT_EQ(components, 3u);
  EXPECT_EQ(members, triangles);
  EXPECT_TRUE(tells_components(bumpy().view));
  EXPECT_EQ(next_component(bumpy().view, 0), image::kNone);
  EXPECT_EQ(first_of_component(bumpy().view, 5), 0u);
}

TEST(RegionImage, Components_that_lead_nowhere_are_refused) {
  const ImageView& view = apart().view;
  const std::uint32_t second = next_component(view, 0);
  const std::uint32_t third = next_component(view, second);
  const auto triangles = static_cast<std::uint32_t>(view.region_triangles.size());
  const auto lead = [&](std::uint32_t from, std::uint32_t to) {
    Damaged image(apart());
    image.triangles()[from].component = to;
    ImageView out;
    return image.check(out);
  };
  ASSERT_EQ(lead(0, second), Status::ok);
  EXPECT_EQ(lead(1, second), Status::image_bad_index) << "forward, from a triangle inside";
  EXPECT_EQ(lead(0, 0), Status::image_bad_index) << "round";
  EXPECT_EQ(lead(0, third), Status::image_bad_index) << "past one";
  EXPECT_EQ(lead(0, image::kNone), Status::image_bad_index) << "to the end";
  EXPECT_EQ(lead(0, triangles), Status::image_bad_index) << "out of the image";
  EXPECT_EQ(lead(third, second), Status::image_bad_index) << "back";
  EXPECT_EQ(lead(triangles - 1, 1), Status::image_bad_index) << "to a triangle that leads on";
  Damaged one;
  one.triangles()[3].component = 2;
  ImageView out;
  EXPECT_EQ(one.check(out), Status::image_bad_index) << "of a single component";
}

TEST(RegionImage, Random_damage_is_refused_or_harmless) {
  std::mt19937 rng(5);
  int accepted = 0;
  for (int round = 0; round < effort(400, 80); ++round) {
    Damaged image;
    const SectionId id = std::array{SectionId::region_nodes, SectionId::region_triangles,
                                    SectionId::regions}[rng() % 3];
    const image::Section s = image.header().sections[static_cast<std::size_t>(id)];
    auto* words = image.section<std::uint32_t>(id);
    const std::size_t count = std::size_t{s.count} * s.stride / 4;
    for (unsigned i = 0; i < 1 + rng() % 3; ++i) words[rng() % count] ^= 1u << (rng() % 32);
    ImageView view;
    if (image.check(view) != Status::ok) continue;
    ++accepted;
    BakedScene scene({view, bumpy().view}, {{0, 1}, {1, 0}},
                     {.engine = EngineKind::regions, .delta_m = 0.05});
    for (int i = 0; i < 3; ++i) {
      const Pose poses[2] = {{{1.9 - 0.1 * i, 0.1, 0}, turn({0.1, 0.2, 0.3})}, {}};
      tick_or_fail(*scene.engine, poses);
    }
  }
  EXPECT_GT(accepted, 0);  // last bits of boxes, sources
}

bake::RegionTree tree_of(const bake::Mesh& mesh, double delta_rel) {
  return bake::build_regions(bake::normalise(mesh), bake::region_options(delta_rel));
}

TEST(RegionTree, Same_mesh_gives_the_same_tree) {
  const bake::Mesh mesh = bumpy_ball(30, 40, 1);
  const bake::RegionTree one = tree_of(mesh, 0.02);
  const bake::RegionTree other = tree_of(mesh, 0.02);
  ASSERT_EQ(one.nodes.size(), other.nodes.size());
  EXPECT_EQ(std::memcmp(one.nodes.data(), other.nodes.data(), one.nodes.size() * 1024), 0);
}

TEST(RegionTree, Leaves_are_nearly_full_and_regions_no_larger_than_asked) {
  const bake::RegionTree tree = tree_of(bumpy_ball(80, 100, 1), 0.02);
  double children = 0;
  double leaves = 0;
  for (const image::RegionNode& n : tree.nodes) {
    if (n.leaf != 0) children += n.children, ++leaves;
  }
  EXPECT_GT(children / leaves, 6);  // regions of about fifty triangles
  for (const image::Region& r : tree.regions) {
    // Boxes hold spheres of the wanted radius.
    EXPECT_LE(double(r.radius), 1.8 * bake::region_options(0.02).radius);
  }
}

/// As a contact's area grows in proportion to delta, so does a region's.
TEST(RegionTree, Regions_are_as_large_as_contacts) {
  EXPECT_EQ(bake::region_options(0.02).radius, 0.16);
  const bake::Mesh ball = bumpy_ball(80, 100, 1);
  const auto fine = static_cast<double>(tree_of(ball, 0.01).regions.size());
  const auto coarse = static_cast<double>(tree_of(ball, 0.04).regions.size());
  EXPECT_GT(fine / coarse, 2.5);
  EXPECT_LT(fine / coarse, 6);
}

/// Least cosine between normals of one region.
double least_cosine(const bake::RegionTree& tree) {
  double least = 1;
  std::vector<std::vector<Vec3d>> normals(tree.regions.size());
  for (const image::RegionTriangle& t : tree.triangles) {
    const Vec3d n = image::normal_of(t);
    normals[t.region].push_back((1 / norm(n)) * n);
  }
  for (const std::vector<Vec3d>& of_region : normals) {
    for (const Vec3d& n : of_region) {
      for (const Vec3d& other : of_region) least = std::min(least, dot(n, other));
    }
  }
  return least;
}

TEST(RegionTree, Opposite_walls_are_in_different_regions) {
  bake::Mesh plate;
  for (int i = 0; i < 8; ++i) append(plate, box(0.1, 0.1, 0.002), 0.2 * i, 0, 0);
  EXPECT_GT(least_cosine(tree_of(plate, 0.05)), 0.9);
}

/// A roof of two slopes, which lean by the angle whose tangent is `steep`, two gables and a floor.
bake::Mesh roof(double half_width, double steep, double length) {
  bake::Mesh m;
  const double x = half_width, h = half_width * steep;
  m.points = {{-x, 0, 0}, {x, 0, 0}, {0, 0, h}, {-x, length, 0}, {x, length, 0}, {0, length, h}};
  m.faces = {{0, 1, 2}, {3, 5, 4}, {0, 2, 5}, {0, 5, 3},
             {1, 4, 5}, {1, 5, 2}, {0, 3, 4}, {0, 4, 1}};
  return m;
}

/// No normal is far from the mean of the two slopes, but they are from one another.
TEST(RegionTree, Slopes_that_face_apart_are_in_different_regions) {
  const bake::RegionTree tree = tree_of(quartered(roof(0.1, 1.1, 2), 4), 0.02);
  EXPECT_GT(least_cosine(tree), 0);
}

TEST(RegionTree, Slopes_that_do_not_face_apart_share_regions) {
  const bake::RegionTree tree = tree_of(quartered(roof(0.1, 0.5, 2), 4), 0.02);
  EXPECT_NEAR(least_cosine(tree), 0.6, 1e-3);  // of two that lean by atan(0.5)
}

/// Flanks of a gear, each of needles as long as it is thick.
TEST(RegionTree, Long_triangles_side_by_side_share_a_region) {
  const bake::RegionTree tree = tree_of(gear(60, 1, 0.5), 0.02);
  EXPECT_EQ(tree.triangles.size(), 1920u);
  EXPECT_LT(tree.regions.size(), 240u);
  EXPECT_GT(tree.regions.size(), 120u);  // as many as there are flanks
}

double longest_edge(const image::RegionTriangle& t) {
  double longest = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3d edge = image::corner_of(t, (k + 1) % 3) - image::corner_of(t, k);
    longest = std::max(longest, norm(edge));
  }
  return longest;
}

/// Else what is detailed would be felt once where it lies on a plate of two triangles.
TEST(RegionTree, Long_triangles_share_no_region_with_short_ones) {
  bake::Mesh mesh = gear(60, 1, 0.5);
  append(mesh, bumpy_ball(30, 40, 0.3), 0.5, 0, 0);
  const bake::RegionTree tree = tree_of(mesh, 0.02);
  const double radius = bake::region_options(0.02).radius;
  std::vector<bool> has_long(tree.regions.size()), has_short(tree.regions.size());
  for (const image::RegionTriangle& t : tree.triangles) {
    (longest_edge(t) > 2 * radius ? has_long : has_short)[t.region] = true;
  }
  for (std::size_t i = 0; i < tree.regions.size(); ++i) EXPECT_FALSE(has_long[i] && has_short[i]);
}

TEST(RegionTree, Smallest_meshes_have_one_region) {
  const bake::RegionTree tree = tree_of(box(1, 1, 1), 4);
  EXPECT_GE(tree.regions.size(), 1u);
  EXPECT_EQ(tree.triangles.size(), 12u);
  bake::Mesh triangle;
  triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.faces = {{0, 1, 2}};
  EXPECT_EQ(tree_of(triangle, 0.01).regions.size(), 1u);
  EXPECT_EQ(tree_of(triangle, 0.01).nodes.size(), 2u);
}

}  // namespace
}  // namespace palpate::test
