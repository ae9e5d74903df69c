// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/partition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/principal_axes.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kGroup = image::kRegionWidth;
constexpr int kNormalRounds = 4;  // of the division of normals into two
// Eight steps of 22.5 degrees make half a turn. Constants, for libm differs between hosts.
constexpr int kDirections = 8;
constexpr double kTurnCosine = 0.92387953251128674;
constexpr double kTurnSine = 0.38268343236508977;
constexpr std::size_t kFaceSample = 512;  // faces that a direction is chosen by

void widen(Vec3d& low, Vec3d& high, Vec3d p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

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
      if (left == 0 && node.count > kGroup) left = divide_compactly(node);
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
      for (std::size_t c = 0; c < 3; ++c) widen(low, high, point(f, c));
    }
    const Vec3d middle = 0.5 * (low + high);
    double squared = 0;
    for (const std::uint32_t f : faces_of(node)) {
      for (std::size_t c = 0; c < 3; ++c)
        squared = std::max(squared, squared_norm(point(f, c) - middle));
    }
    return std::sqrt(squared);
  }

  /// Half its longest edge.
  double reach_of(std::uint32_t face) const {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      squared = std::max(squared, squared_norm(point(face, c) - point(face, (c + 1) % 3)));
    }
    return 0.5 * std::sqrt(squared);
  }

  /// Longer than a region is wide, and so narrow that two lie side by side within one.
  bool is_needle(std::uint32_t face) const {
    const double reach = reach_of(face);
    return reach > options_.radius && norm(normals_[face]) <= 2 * reach * options_.radius;
  }

  /// Needles side by side: divided they would be as long, and far more.
  bool is_strip(std::span<const std::uint32_t> faces) const {
    double longest = 0;
    for (const std::uint32_t f : faces) longest = std::max(longest, reach_of(f));
    const Vec3d half = 0.5 * extents_of(faces);
    return half.y <= options_.radius && half.z <= longest + options_.radius;
  }

  /// How many faces go to the left half; 0: it is a region as it stands.
  std::uint32_t divide_region(const Node& node) {
    if (node.count < 2) return 0;
    const double radius = radius_of(node);
    if (radius < options_.least_share * options_.radius) return 0;
    const auto faces = faces_of(node);
    const bool large = radius > options_.radius;
    if (large && !std::ranges::all_of(faces, [&](auto f) { return is_needle(f); })) {
      return divide_position(node);
    }
    const std::uint32_t left = divide_normals(node);
    return large && left == 0 && !is_strip(faces) ? divide_position(node) : left;
  }

  /// In the middle of the longest principal axis.
  std::uint32_t divide_position(const Node& node) {
    const auto faces = faces_of(node);
    const std::uint32_t left = node.count / 2;
    divide_across(principal(faces).row2, faces, left);
    return left;
  }

  /// Across the direction that leaves the roundest parts, at a multiple of sixteen, so that groups
  /// are full.
  std::uint32_t divide_compactly(const Node& node) {
    const auto faces = faces_of(node);
    const std::uint32_t groups = (node.count / 2 + kGroup / 2) / kGroup;
    const std::uint32_t left = std::max(1u, groups) * kGroup;
    divide_across(across_round_parts(faces, left), faces, left);
    return left;
  }

  Mat3d principal(std::span<const std::uint32_t> faces) const {
    Moments moments;
    for (const std::uint32_t f : faces) moments.add(centres_[f]);
    return principal_axes(moments);
  }

  /// Puts the `left` faces that come first along an axis before the others.
  void divide_across(Vec3d axis, std::span<std::uint32_t> faces, std::uint32_t left) const {
    const auto middle = faces.begin() + left;
    std::nth_element(faces.begin(), middle, faces.end(), [&](std::uint32_t x, std::uint32_t y) {
      const double kx = dot(axis, centres_[x]);
      const double ky = dot(axis, centres_[y]);
      return kx < ky || (kx == ky && x < y);
    });
    // nth_element leaves an order of its own behind.
    std::sort(faces.begin(), middle);
    std::sort(middle, faces.end());
  }

  /// Of eight directions along the patch that the faces are, the one across which `left` of them
  /// and the others have the shortest diagonals.
  Vec3d across_round_parts(std::span<const std::uint32_t> faces, std::uint32_t left) const {
    std::vector<std::uint32_t> sample;
    const std::size_t step = (faces.size() + kFaceSample - 1) / kFaceSample;
    for (std::size_t i = 0; i < faces.size(); i += step) sample.push_back(faces[i]);
    const auto share = static_cast<std::uint32_t>(left * sample.size() / faces.size());
    const Mat3d along = principal(sample);
    Vec3d u = along.row2;
    Vec3d v = along.row1;
    Vec3d best = u;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kDirections; ++i) {
      divide_across(u, sample, share);
      const auto parts = std::span(sample);
      const double size = size_of(parts.first(share)) + size_of(parts.subspan(share));
      if (size < least) {
        least = size;
        best = u;
      }
      const Vec3d turned = kTurnCosine * u + kTurnSine * v;
      v = kTurnCosine * v - kTurnSine * u;
      u = turned;
    }
    return best;
  }

  /// Of the box along the principal axes of some faces' corners, the longest last.
  Vec3d extents_of(std::span<const std::uint32_t> faces) const {
    Moments moments;
    for (const std::uint32_t f : faces) {
      for (std::size_t c = 0; c < 3; ++c) moments.add(point(f, c));
    }
    const Mat3d axes = principal_axes(moments);
    Vec3d low{2, 2, 2};
    Vec3d high{-2, -2, -2};
    for (const std::uint32_t f : faces) {
      for (std::size_t c = 0; c < 3; ++c) widen(low, high, axes * point(f, c));
    }
    return high - low;
  }

  double size_of(std::span<const std::uint32_t> faces) const {
    return squared_norm(extents_of(faces));
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
    if (middle == faces.begin() || middle == faces.end()) return divide_position(node);
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
  constexpr double kRadius = 0.16;  // for contacts within this:
  constexpr double kDelta = 0.02;
  constexpr double kLeast = 0.03;
  constexpr double kMost = 0.25;
  RegionOptions options;
  options.radius = std::clamp(kRadius * std::sqrt(delta_rel / kDelta), kLeast, kMost);
  return options;
}

Partition divide(const NormalMesh& mesh, const RegionOptions& options) {
  return Divider(mesh, options).run();
}

}  // namespace palpate::bake
