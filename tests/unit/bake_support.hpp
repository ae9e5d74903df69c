// SPDX-License-Identifier: GPL-3.0-or-later
// Images and hierarchies of small meshes for the baker's tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/pack/aligned.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {

/// An image in memory, validated.
struct Image {
  explicit Image(const std::vector<std::byte>& bytes) : memory(bytes) {
    EXPECT_EQ(validate(memory.bytes(), view), Status::ok);
  }
  AlignedCopy memory;
  ImageView view;
};

inline std::vector<std::byte> bake_bytes(const Mesh& mesh, unsigned threads = 0,
                                         double delta_rel = 0.01) {
  BakeReport report;
  BakeOptions options;
  options.delta_rel = delta_rel;
  options.threads = threads;
  return bake(mesh, check(mesh), options, {}, report);
}

/// Two spheres apart from each other; `distance` between their surfaces, for radius 1.
inline Mesh two_spheres(double distance = 0.5, int subdivisions = 2) {
  return together(sphere({0, 0, 0}, 1, subdivisions),
                  sphere({2 + distance, 0, 0}, 1, subdivisions));
}

/// A sphere with dents: a closed surface of many patches.
inline Mesh dented_sphere(int subdivisions = 3) {
  Mesh mesh = sphere({0, 0, 0}, 1, subdivisions);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (i % 3 != 0) continue;
    for (double& c : mesh.points[i]) c *= 0.93;
  }
  return mesh;
}

/// The simplest decomposition there is: every triangle a patch of its own.
inline std::vector<Patch> triangle_patches(const NormalMesh& mesh) {
  std::vector<Patch> patches;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Face corners = mesh.faces[f];
    std::sort(corners.begin(), corners.end());
    Patch patch;
    patch.faces = {f};
    patch.vertices.assign(corners.begin(), corners.end());
    patch.hull = {{0, 1, 2}, {{0, 1, 2}, {0, 2, 1}}, 2};
    patch.all_real = true;
    patches.push_back(patch);
  }
  return patches;
}

inline Hierarchy triangle_tree(const Mesh& mesh) {
  const NormalMesh normal = normalise(mesh);
  return level_zero(normal, triangle_patches(normal), 1);
}

}  // namespace palpate::bake::testing
