// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/support_area.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/metrics/support_area_grown.hpp"
#include "host_bake/metrics/vector.hpp"
#include "mesh_support.hpp"

namespace palpate::bake {
namespace {

std::vector<float> areas(const NormalMesh& mesh, double delta, SupportReading reading) {
  return support_areas(mesh, vertex_normals(mesh), delta, reading);
}

std::vector<float> grown(const NormalMesh& mesh, double delta) {
  return areas(mesh, delta, SupportReading::grown);
}

// The definition, without a flood that remembers: faces joined until nothing changes.
double grown_by_force(const NormalMesh& mesh, const std::vector<Vec3d>& normals, std::uint32_t v,
                      double delta) {
  const Vec3d n = normals[v];
  const auto height = [&](std::uint32_t w) {
    return dot(vec(mesh.points[w]) - vec(mesh.points[v]), n);
  };
  const auto projected = [&](const Face& f) {
    const Vec3d a = vec(mesh.points[f[0]]);
    return 0.5 * dot(cross(vec(mesh.points[f[1]]) - a, vec(mesh.points[f[2]]) - a), n);
  };
  const auto joined = [&](const Face& f, const Face& g) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = f[i], b = f[(i + 1) % 3];
      const double low = std::min(height(a), height(b)), high = std::max(height(a), height(b));
      if (low > delta || high < -delta) continue;
      if (std::count(g.begin(), g.end(), a) > 0 && std::count(g.begin(), g.end(), b) > 0)
        return true;
    }
    return false;
  };
  std::vector<char> in(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < in.size(); ++f) {
    in[f] = projected(mesh.faces[f]) > 0 &&
            std::count(mesh.faces[f].begin(), mesh.faces[f].end(), v) > 0;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t f = 0; f < in.size(); ++f) {
      for (std::size_t g = 0; in[f] != 0 && g < in.size(); ++g) {
        if (in[g] != 0 || projected(mesh.faces[g]) <= 0) continue;
        if (!joined(mesh.faces[f], mesh.faces[g])) continue;
        in[g] = 1;
        changed = true;
      }
    }
  }
  double area = 0;
  for (std::size_t f = 0; f < in.size(); ++f) {
    const Face& face = mesh.faces[f];
    if (in[f] == 0) continue;
    area +=
        projected(face) * share_within({height(face[0]), height(face[1]), height(face[2])}, delta);
  }
  return area;
}

TEST(ShareWithin, Agrees_with_counting) {
  for (const std::array<double, 3>& h :
       {std::array{-0.3, 0.1, 0.5}, {0.2, 0.2, 0.9}, {-0.7, -0.2, -0.2}, {0.05, -0.05, 0.02}}) {
    for (const double limit : {0.02, 0.1, 0.2, 0.4, 1.0}) {
      constexpr int kSteps = 800;
      int within = 0, all = 0;
      for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; i + j < kSteps; ++j, ++all) {
          const double u = (i + 1.0 / 3) / kSteps, w = (j + 1.0 / 3) / kSteps;
          within += std::abs(h[0] + u * (h[1] - h[0]) + w * (h[2] - h[0])) <= limit ? 1 : 0;
        }
      }
      EXPECT_NEAR(share_within(h, limit), static_cast<double>(within) / all, 4e-3);
    }
  }
}

TEST(ShareWithin, Level_triangles_are_in_or_out) {
  EXPECT_EQ(share_within({0.1, 0.1, 0.1}, 0.2), 1);
  EXPECT_EQ(share_within({0.3, 0.3, 0.3}, 0.2), 0);
  EXPECT_EQ(share_within({-0.3, -0.3, -0.3}, 0.2), 0);
}

TEST(GrownSupportArea, Agrees_with_the_definition) {
  const NormalMesh torus = normalise(test::torus(16, 10, 0.4, 0.05, 5));
  const NormalMesh open = normalise(test::open_hemisphere(5));
  for (const NormalMesh& mesh : {torus, open}) {
    const std::vector<Vec3d> normals = vertex_normals(mesh);
    for (const double delta : {0.01, 0.1, 0.4}) {
      const std::vector<double> found = grown_areas(mesh, normals, delta);
      for (std::uint32_t v = 0; v < mesh.points.size(); v += 3)
        EXPECT_NEAR(found[v], grown_by_force(mesh, normals, v, delta), 1e-12);
    }
  }
}

TEST(GrownSupportArea, Cap_of_a_sphere_whatever_the_tessellation) {
  // The cap of height delta has a rim of radius sqrt(2 delta - delta^2).
  for (const double delta : {0.02, 0.1}) {
    const double cap = std::numbers::pi * (2 * delta - delta * delta);
    for (const int n : {24, 48}) {
      const std::vector<float> found = grown(normalise(test::sphere(n)), delta);
      EXPECT_NEAR(*std::min_element(found.begin(), found.end()), cap, 0.1 * cap);
      EXPECT_NEAR(*std::max_element(found.begin(), found.end()), cap, 0.1 * cap);
    }
  }
}

TEST(GrownSupportArea, Sheet_is_all_support) {
  const NormalMesh sheet = normalise(testing::sheet(5));
  const double whole = 25 / (sheet.radius_m * sheet.radius_m);
  for (const float area : grown(sheet, 1e-6)) EXPECT_NEAR(static_cast<double>(area), whole, 1e-5);
}

TEST(GrownSupportArea, Does_not_jump_over_a_gap) {
  const NormalMesh both = normalise(
      testing::together(testing::sphere({0, 0, 0}, 1, 2), testing::sphere({0, 0, 2.01}, 1, 2)));
  const std::vector<float> found = grown(both, 0.1);
  const std::vector<float> alone =
      areas(both, 0.1, SupportReading::one_ring);  // at most its own faces
  const double cap = std::numbers::pi * 2 * 0.1;   // about: radius 1 is of both spheres here
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_GE(found[v], alone[v]);
    EXPECT_LT(static_cast<double>(found[v]), cap);
  }
}

TEST(GrownSupportArea, Never_less_than_one_ring) {
  const NormalMesh mesh = normalise(test::torus(40, 20, 0.4, 0.05, 5));
  for (const double delta : {0.002, 0.02, 0.2}) {
    const std::vector<float> strict = areas(mesh, delta, SupportReading::one_ring);
    const std::vector<float> wide = grown(mesh, delta);
    for (std::size_t v = 0; v < wide.size(); ++v) EXPECT_GE(wide[v], strict[v] * 0.999999f);
  }
}

TEST(GrownSupportArea, Same_floor_as_one_ring) {
  // A tip of a needle supports nothing within so small a delta.
  const NormalMesh needle{{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 50}},
                          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
                          {},
                          1};
  EXPECT_EQ(grown(needle, 1e-6)[4], areas(needle, 1e-6, SupportReading::one_ring)[4]);
  EXPECT_GT(grown(needle, 1e-6)[4], 0.01f);
}

TEST(GrownSupportArea, Same_bits_on_one_thread_and_on_many) {
  const NormalMesh mesh = normalise(test::torus(60, 30, 0.4, 0.05, 5));
  const auto on_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return grown(mesh, 0.05);
  };
  EXPECT_EQ(on_threads(1), on_threads(4));
}

}  // namespace
}  // namespace palpate::bake
