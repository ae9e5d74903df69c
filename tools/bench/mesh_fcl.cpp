// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/mesh_fcl.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <vector>

namespace palpate::bench {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

void fill(const bake::Mesh& mesh, Model& model) {
  std::vector<fcl::Vector3<double>> points;
  points.reserve(mesh.points.size());
  for (const bake::Point& p : mesh.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.faces.size());
  for (const bake::Face& f : mesh.faces) triangles.emplace_back(f[0], f[1], f[2]);
  model.beginModel();
  model.addSubModel(points, triangles);
  model.endModel();
}

fcl::Transform3<double> transform(const Pose& pose) {
  const Quat& q = pose.orientation;
  fcl::Transform3<double> t = fcl::Transform3<double>::Identity();
  t.linear() = fcl::Quaternion<double>(q.w, q.x, q.y, q.z).toRotationMatrix();
  t.translation() << pose.position_m.x, pose.position_m.y, pose.position_m.z;
  return t;
}

}  // namespace

struct FclPair::Models {
  Model a;
  Model b;
};

FclPair::FclPair(const bake::Mesh& a, const bake::Mesh& b) : models_(std::make_unique<Models>()) {
  fill(a, models_->a);
  fill(b, models_->b);
}

FclPair::~FclPair() = default;

double FclPair::distance(const Pose& a, const Pose& b) const {
  const fcl::DistanceRequest<double> request(false);
  fcl::DistanceResult<double> result;
  return fcl::distance(&models_->a, transform(a), &models_->b, transform(b), request, result);
}

std::size_t FclPair::crossings(const Pose& a, const Pose& b, std::size_t most) const {
  const fcl::CollisionRequest<double> request(most, true);
  fcl::CollisionResult<double> result;
  return fcl::collide(&models_->a, transform(a), &models_->b, transform(b), request, result);
}

}  // namespace palpate::bench
