// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/convex_fcl.hpp"

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include <vector>

namespace palpate::bench {
namespace {

using Vector = fcl::Vector3<double>;
using Transform = fcl::Transform3<double>;

fcl::Convex<double> shape(const BenchHull& hull) {
  auto points = std::make_shared<std::vector<Vector>>();
  for (const image::Vertex& v : hull.vertices) {
    const Vec3d p = vec_cast<double>(Vec3f{v.position[0], v.position[1], v.position[2]});
    points->emplace_back(p.x, p.y, p.z);
  }
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& f : hull.faces) {
    faces->push_back(3);
    for (const std::uint32_t v : f) faces->push_back(static_cast<int>(v));
  }
  return {points, static_cast<int>(hull.faces.size()), faces};
}

Transform transform(const RelativePose& pose) {
  Transform t = Transform::Identity();
  const Mat3d& r = pose.rotation;
  t.linear() << r.row0.x, r.row0.y, r.row0.z, r.row1.x, r.row1.y, r.row1.z, r.row2.x, r.row2.y,
      r.row2.z;
  t.translation() << pose.translation.x, pose.translation.y, pose.translation.z;
  return t;
}

Vec3d vec(const Vector& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

struct FclMotion::Shapes {
  explicit Shapes(const Motion& motion) : a(shape(motion.a)), b(shape(motion.b)) {
    for (const RelativePose& pose : motion.poses) b_in_a.push_back(transform(pose));
  }
  fcl::detail::GJKSolver_libccd<double> solver;
  fcl::Convex<double> a;
  fcl::Convex<double> b;
  std::vector<Transform, Eigen::aligned_allocator<Transform>> b_in_a;
};

FclMotion::FclMotion(const Motion& motion) : shapes_(std::make_unique<Shapes>(motion)) {}
FclMotion::~FclMotion() = default;
FclMotion::FclMotion(FclMotion&&) noexcept = default;

PeerAnswer FclMotion::distance(std::uint32_t pose) const {
  const Transform& b_in_a = shapes_->b_in_a[pose];
  PeerAnswer answer;
  Vector on_a;
  Vector on_b;
  shapes_->solver.shapeDistance(shapes_->a, Transform::Identity(), shapes_->b, b_in_a,
                                &answer.distance, &on_a, &on_b);
  answer.point_a = vec(on_a);
  answer.point_b = vec(on_b);
  return answer;
}

}  // namespace palpate::bench
