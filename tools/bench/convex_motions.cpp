// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/convex_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "host_bake/hull/hull.hpp"
#include "rt_core/convex/distance.hpp"

namespace palpate::bench {
namespace {

using Random = std::mt19937_64;

constexpr double kStep = 0.001;  // of the radius, which is 1
constexpr double kTurn_rad = 0.2 * std::numbers::pi / 180;
constexpr std::uint32_t kLegSteps = 50;  // poses between changes of course

double uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

Vec3d random_unit(Random& random) {
  const double z = uniform(random, -1, 1);
  const double angle = uniform(random, 0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Quat about(Vec3d unit_axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), s * unit_axis.x, s * unit_axis.y, s * unit_axis.z};
}

Quat normalised(Quat q) {
  const double inverse = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * inverse, q.x * inverse, q.y * inverse, q.z * inverse};
}

BenchHull make_hull(std::uint32_t vertices, Random& random) {
  const Vec3d half{1, uniform(random, 0.6, 1), uniform(random, 0.6, 1)};
  std::vector<bake::PointF> points(vertices);
  for (bake::PointF& p : points) {
    const Vec3d u = random_unit(random);
    p = {static_cast<float>(half.x * u.x), static_cast<float>(half.y * u.y),
         static_cast<float>(half.z * u.z)};
  }
  const bake::HullMesh mesh = bake::convex_hull(points);
  if (mesh.vertices.size() != vertices) return make_hull(vertices, random);
  BenchHull hull;
  for (const std::uint32_t v : mesh.vertices) {
    hull.vertices.push_back({{points[v][0], points[v][1], points[v][2]}, 0});
  }
  std::vector<std::set<std::uint32_t>> joined(vertices);
  for (const auto& f : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      joined[f[k]].insert(f[(k + 1) % 3]);
      joined[f[(k + 1) % 3]].insert(f[k]);
    }
  }
  hull.starts.push_back(0);
  for (const auto& list : joined) {
    hull.neighbours.insert(hull.neighbours.end(), list.begin(), list.end());
    hull.starts.push_back(static_cast<std::uint32_t>(hull.neighbours.size()));
  }
  hull.faces = mesh.faces;
  return hull;
}

convex::Distance exact_distance(const Motion& motion, const RelativePose& pose) {
  convex::Cache cold;
  return convex::distance(motion.a.baked(), motion.b.baked(), pose, {}, cold);
}

/// A random pose with the hulls `gap` apart.
RelativePose place(const Motion& motion, const Mat3d& turned, double gap, Random& random) {
  RelativePose pose{turned, 3.0 * random_unit(random)};
  for (int i = 0; i < 20; ++i) {
    const convex::Distance d = exact_distance(motion, pose);
    pose.translation += (d.distance - gap) * d.normal;
  }
  return pose;
}

void add_incoherent(Motion& motion, std::uint32_t steps, Random& random) {
  for (std::uint32_t i = 0; i < steps; ++i) {
    const Quat turn = about(random_unit(random), uniform(random, 0, std::numbers::pi));
    const double gap = uniform(random, kLeastGap, kLargestGap);
    motion.poses.push_back(place(motion, rotation(turn), gap, random));
  }
}

/// Straight legs with a constant turn. A leg that leaves the range of gaps is turned back.
void add_coherent(Motion& motion, std::uint32_t steps, Random& random) {
  Quat turn = about(random_unit(random), uniform(random, 0, std::numbers::pi));
  const double first_gap = uniform(random, kLeastGap, kLargestGap);
  Vec3d at = place(motion, rotation(turn), first_gap, random).translation;
  Vec3d axis = random_unit(random);
  Vec3d course = random_unit(random);
  for (std::uint32_t i = 0; i < steps; ++i) {
    if (i % kLegSteps == 0) {
      axis = random_unit(random);
      course = random_unit(random);
    }
    turn = normalised(about(axis, kTurn_rad) * turn);
    RelativePose next{rotation(turn), at + kStep * course};
    const convex::Distance d = exact_distance(motion, next);
    const double gap = std::clamp(d.distance, kLeastGap, kLargestGap);
    if (gap != d.distance) {
      course = course - (2 * dot(course, d.normal)) * d.normal;
      next.translation += (d.distance - gap) * d.normal;
    }
    at = next.translation;
    motion.poses.push_back(next);
  }
}

}  // namespace

convex::Hull BenchHull::scanned() const {
  convex::Hull hull;
  hull.vertices = vertices.data();
  hull.count = static_cast<std::uint32_t>(vertices.size());
  return hull;
}

convex::Hull BenchHull::climbed() const {
  convex::Hull hull = scanned();
  hull.starts = starts.data();
  hull.neighbours = neighbours.data();
  return hull;
}

convex::Hull BenchHull::baked() const {
  return vertices.size() > image::kAdjacencyAbove ? climbed() : scanned();
}

std::vector<Motion> make_motions(std::uint32_t vertices, Coherence coherence, std::uint32_t pairs,
                                 std::uint32_t steps) {
  Random random(vertices);
  std::vector<Motion> motions(pairs);
  for (Motion& motion : motions) {
    motion.a = make_hull(vertices, random);
    motion.b = make_hull(vertices, random);
    motion.poses.reserve(steps);
    if (coherence == Coherence::coherent) {
      add_coherent(motion, steps, random);
    } else {
      add_incoherent(motion, steps, random);
    }
  }
  return motions;
}

double distance_error(const Motion& motion, const RelativePose& pose, double distance,
                      Vec3d normal) {
  using Real = Vec3<long double>;
  const Mat3<long double> turn{vec_cast<long double>(pose.rotation.row0),
                               vec_cast<long double>(pose.rotation.row1),
                               vec_cast<long double>(pose.rotation.row2)};
  const Real n = vec_cast<long double>(normal);
  const auto point = [](const image::Vertex& v) {
    return vec_cast<long double>(Vec3f{v.position[0], v.position[1], v.position[2]});
  };
  long double lowest_a = std::numeric_limits<long double>::infinity();
  long double highest_b = -lowest_a;
  for (const image::Vertex& v : motion.a.vertices) {
    lowest_a = std::min(lowest_a, dot(n, point(v)));
  }
  for (const image::Vertex& v : motion.b.vertices) {
    highest_b =
        std::max(highest_b, dot(n, turn * point(v) + vec_cast<long double>(pose.translation)));
  }
  const long double gap = (lowest_a - highest_b) / std::sqrt(squared_norm(n));
  return static_cast<double>(std::abs(static_cast<long double>(distance) - gap));
}

}  // namespace palpate::bench
