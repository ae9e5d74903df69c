// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/partition.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/principal_axes.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kGroup = image::kRegionWidth;
constexpr int kNormalRounds = 4;  // of the division of normals into two

class Divider {
 public:
  Divider(const NormalMesh& mesh, const RegionOptions& options)
      : mesh_(mesh), options_(options), centres_(mesh.faces.size()), normals_(mesh.faces.size()) {
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const Vec3d a = point(i, 0);
      const Vec3d b = point(i, 1);
      const Vec3d c = point(i, 2);
      centres_[i] = (1.0 / 3) * (a + b + c);
      normals_[i] = cross(b - a, c - a);
      out_.faces.push_back(static_cast<std::uint32_t>(i));
    }
  }

  Partition run() && {
    out_.nodes.push_back({0, static_cast<std::uint32_t>(mesh_.faces.size()), 0, false});
    std::vector<std::uint32_t> open{0};
    std::vector<char> inside{0};  // beside nodes: lies in a region already
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      Partition::Node node = out_.nodes[index];
      std::uint32_t left = 0;
      bool within = inside[index] != 0;
      if (!within) {
        left = divide_region(node);
        node.region = left == 0;
        within = node.region;
      }
      if (left == 0 && node.count > kGroup) left = divide_position(node, true);
      if (left != 0) {
        node.child = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes.push_back({node.first, left, 0, false});
        out_.nodes.push_back({node.first + left, node.count - left, 0, false});
        inside.resize(out_.nodes.size(), within ? 1 : 0);
        open.push_back(node.child + 1);
        open.push_back(node.child);
      }
      out_.nodes[index] = node;
    }
    return std::move(out_);
  }

 private:
  using Node = Partition::Node;

  Vec3d point(std::size_t face, std::size_t corner) const {
    return vec(mesh_.points[mesh_.faces[face][corner]]);
  }
  std::span<std::uint32_t> faces_of(const Node& node) {
    return std::span(out_.faces).subspan(node.first, node.count);
  }

  double radius_of(const Node& node) {
    Vec3d low{2, 2, 2};
    Vec3d high{-2, -2, -2};
    for (const std::uint32_t f : faces_of(node)) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = point(f, c);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    const Vec3d middle = 0.5 * (low + high);
    double squared = 0;
    for (const std::uint32_t f : faces_of(node)) {
      for (std::size_t c = 0; c < 3; ++c)
        squared = std::max(squared, squared_norm(point(f, c) - middle));
    }
    return std::sqrt(squared);
  }

  /// How many faces go to the left half; 0: it is a region as it stands.
  std::uint32_t divide_region(const Node& node) {
    if (node.count < 2) return 0;
    const double radius = radius_of(node);
    if (radius > options_.radius) return divide_position(node, false);
    if (radius < options_.least_share * options_.radius) return 0;
    return divide_normals(node);
  }

  std::uint32_t divide_position(const Node& node, bool full_groups) {
    const auto faces = faces_of(node);
    Moments moments;
    for (const std::uint32_t f : faces) moments.add(centres_[f]);
    const Vec3d axis = principal_axes(moments).row2;
    const auto key = [&](std::uint32_t f) { return dot(axis, centres_[f]); };
    std::uint32_t left = node.count / 2;
    if (full_groups) left = std::max(kGroup, (left + kGroup / 2) / kGroup * kGroup);
    std::nth_element(faces.begin(), faces.begin() + left, faces.end(),
                     [&](std::uint32_t x, std::uint32_t y) {
                       const double kx = key(x);
                       const double ky = key(y);
                       return kx < ky || (kx == ky && x < y);
                     });
    // nth_element leaves an order of its own behind.
    std::sort(faces.begin(), faces.begin() + left);
    std::sort(faces.begin() + left, faces.end());
    return left;
  }

  /// Two groups of like normals (2-means, seeded by the mean and what is farthest from it).
  std::uint32_t divide_normals(const Node& node) {
    const auto faces = faces_of(node);
    Vec3d mean{};
    for (const std::uint32_t f : faces) mean += normals_[f];
    mean = unit(mean);
    Vec3d odd = mean;
    double least = 1;
    for (const std::uint32_t f : faces) {
      const Vec3d n = unit(normals_[f]);
      if (squared_norm(n) > 0 && dot(n, mean) < least) {
        least = dot(n, mean);
        odd = n;
      }
    }
    const bool turns = least < options_.cosine;
    // Groups are at most twice as far apart as the farthest normal is from the mean.
    if (!turns && 2 * least * least - 1 >= options_.walls_cosine) return 0;
    Vec3d to[2] = {mean, odd};
    const auto is_odd = [&](std::uint32_t f) {
      return dot(normals_[f], to[1]) > dot(normals_[f], to[0]);
    };
    for (int round = 0; round < kNormalRounds; ++round) {
      Vec3d sum[2] = {};
      for (const std::uint32_t f : faces) sum[is_odd(f) ? 1 : 0] += normals_[f];
      to[0] = unit(sum[0]);
      to[1] = unit(sum[1]);
    }
    if (!turns && dot(to[0], to[1]) >= options_.walls_cosine) return 0;
    const auto middle = std::stable_partition(faces.begin(), faces.end(),
                                              [&](std::uint32_t f) { return !is_odd(f); });
    if (middle == faces.begin() || middle == faces.end()) return divide_position(node, false);
    return static_cast<std::uint32_t>(middle - faces.begin());
  }

  const NormalMesh& mesh_;
  const RegionOptions& options_;
  std::vector<Vec3d> centres_;
  std::vector<Vec3d> normals_;  // area-weighted
  Partition out_;
};

}  // namespace

RegionOptions region_options(double delta_rel) {
  constexpr double kDeltas = 8;
  constexpr double kLeast = 0.03;
  constexpr double kMost = 0.25;
  RegionOptions options;
  options.radius = std::clamp(kDeltas * delta_rel, kLeast, kMost);
  return options;
}

Partition divide(const NormalMesh& mesh, const RegionOptions& options) {
  return Divider(mesh, options).run();
}

}  // namespace palpate::bake
