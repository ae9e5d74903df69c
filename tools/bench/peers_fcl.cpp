// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/peers_fcl.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <vector>

namespace palpate::bench {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSS<double>>;
using Transform = fcl::Transform3<double>;

void fill(const bake::Mesh& mesh, Model& out) {
  std::vector<fcl::Vector3<double>> points;
  for (const bake::Point& p : mesh.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<fcl::Triangle> triangles;
  for (const bake::Face& f : mesh.faces) triangles.emplace_back(f[0], f[1], f[2]);
  out.beginModel();
  out.addSubModel(points, triangles);
  out.endModel();
}

Transform transform(const Pose& pose) {
  const Quat& q = pose.orientation;
  Transform t = Transform::Identity();
  t.linear() = fcl::Quaternion<double>(q.w, q.x, q.y, q.z).toRotationMatrix();
  t.translation() << pose.position_m.x, pose.position_m.y, pose.position_m.z;
  return t;
}

}  // namespace

struct FclPair::Models {
  Model a, b;
};

FclPair::FclPair(const bake::Mesh& a, const bake::Mesh& b) : models_(std::make_unique<Models>()) {
  fill(a, models_->a);
  fill(b, models_->b);
}
FclPair::~FclPair() = default;

double FclPair::distance_m(const Pose& a, const Pose& b) const {
  fcl::DistanceRequest<double> request;
  fcl::DistanceResult<double> result;
  return fcl::distance(&models_->a, transform(a), &models_->b, transform(b), request, result);
}

std::size_t FclPair::crossings(const Pose& a, const Pose& b, std::size_t most) const {
  fcl::CollisionRequest<double> request(most, true);
  fcl::CollisionResult<double> result;
  return fcl::collide(&models_->a, transform(a), &models_->b, transform(b), request, result);
}

}  // namespace palpate::bench
