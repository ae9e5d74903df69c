// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/culling.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/hausdorff.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

// A Fibonacci lattice: even enough, for any number.
std::array<Eigen::Vector3d, image::kMaxCullingVertices> even_directions() {
  constexpr double kGoldenAngle = 2.399963229728653;
  std::array<Eigen::Vector3d, image::kMaxCullingVertices> directions;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(directions.size());
    const double across = std::sqrt(1 - z * z);
    const double turn = kGoldenAngle * static_cast<double>(i);
    directions[i] = {across * std::cos(turn), across * std::sin(turn), z};
  }
  return directions;
}

Eigen::Vector3d eigen(const PointF& p) {
  return Eigen::Map<const Eigen::Vector3f>(p.data()).cast<double>();
}

// Maps a direction so that extreme points along it are those of the points with their covariance
// made a sphere.
Eigen::Matrix3d whitening(std::span<const PointF> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PointF& p : points) mean += eigen(p);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PointF& p : points) {
    const Eigen::Vector3d d = eigen(p) - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  // Flat sets have a smallest extent of 0: a floor keeps the map finite.
  constexpr double kLeastShare = 1e-12;
  const Eigen::Vector3d spread =
      solver.eigenvalues().cwiseMax(std::max(kLeastShare * solver.eigenvalues()[2], 1e-30));
  const Eigen::Vector3d inverse = spread.cwiseSqrt().cwiseInverse();
  return solver.eigenvectors() * inverse.asDiagonal();
}

// Positions in `points`, ascending, no repeats.
std::vector<std::uint32_t> spread_out(std::span<const PointF> points) {
  static const auto kDirections = even_directions();
  const Eigen::Matrix3d map = whitening(points);
  std::vector<std::uint32_t> chosen;
  for (const Eigen::Vector3d& even : kDirections) {
    const Eigen::Vector3d along = map * even;
    std::uint32_t best = 0;
    double most = along.dot(eigen(points[0]));
    for (std::uint32_t i = 1; i < points.size(); ++i) {
      const double d = along.dot(eigen(points[i]));
      if (d > most) {
        most = d;
        best = i;
      }
    }
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

// Extreme points stay extreme among fewer, so every chosen one is a hull vertex.
CullingBound reduced(const Hierarchy& tree, const std::vector<std::uint32_t>& enclosing) {
  if (enclosing.size() <= image::kMaxCullingVertices) return {enclosing, 0};
  const std::vector<PointF> points = positions(tree, enclosing);
  CullingBound bound;
  std::vector<PointF> kept;
  for (const std::uint32_t i : spread_out(points)) {
    bound.points.push_back(enclosing[i]);
    kept.push_back(points[i]);
  }
  const HullMesh hull = convex_hull(kept);
  std::vector<PointF> corners;
  for (const std::uint32_t v : hull.vertices) corners.push_back(kept[v]);
  bound.residual = largest_distance(points, corners, hull.faces, hull.dimension);
  return bound;
}

}  // namespace

std::vector<CullingBound> culling_bounds(const Hierarchy& tree,
                                         const std::vector<float>& hausdorff) {
  std::vector<CullingBound> bounds(tree.pieces.size());
  parallel_for(tree.pieces.size(), [&](std::size_t i) {
    bounds[i].residual = hausdorff[i];
    if (hausdorff[i] == 0) return;
    CullingBound tight = reduced(tree, tree.pieces[i].enclosing);
    if (tight.residual < hausdorff[i]) bounds[i] = std::move(tight);
  });
  return bounds;
}

}  // namespace palpate::bake
