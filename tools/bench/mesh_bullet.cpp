// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/mesh_bullet.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

namespace palpate::bench {
namespace {

constexpr double kUnits_per_m = 1e3;

btScalar scaled(double metres) { return static_cast<btScalar>(kUnits_per_m * metres); }

btTransform transform(const Pose& pose) {
  const auto f = [](double v) { return static_cast<btScalar>(v); };
  const Quat& q = pose.orientation;
  const Vec3d& p = pose.position_m;
  return btTransform(btQuaternion(f(q.x), f(q.y), f(q.z), f(q.w)),
                     btVector3(scaled(p.x), scaled(p.y), scaled(p.z)));
}

/// A mesh as Bullet wants it; Bullet keeps pointers into it.
struct Body {
  Body(const bake::Mesh& mesh, double margin_m) {
    for (const bake::Point& p : mesh.points) {
      for (const double x : p) points.push_back(scaled(x));
    }
    for (const bake::Face& face : mesh.faces) {
      for (const std::uint32_t v : face) corners.push_back(static_cast<int>(v));
    }
    triangles = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.faces.size()), corners.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.points.size()), points.data(),
        static_cast<int>(3 * sizeof(btScalar)));
    shape = std::make_unique<btGImpactMeshShape>(triangles.get());
    shape->setMargin(scaled(margin_m));
    shape->updateBound();
    object.setCollisionShape(shape.get());
  }

  std::vector<btScalar> points;
  std::vector<int> corners;
  std::unique_ptr<btTriangleIndexVertexArray> triangles;
  std::unique_ptr<btGImpactMeshShape> shape;
  btCollisionObject object;
};

/// Counts what a manifold would reduce to four points.
class Counting : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;

  void addContactPoint(const btVector3&, const btVector3&, btScalar depth) override {
    ++count;
    least = std::min(least, depth);
  }

  std::size_t count = 0;
  btScalar least = std::numeric_limits<btScalar>::infinity();
};

}  // namespace

struct BulletPair::World {
  World(const bake::Mesh& mesh_a, const bake::Mesh& mesh_b, double delta_m_)
      : delta_m(delta_m_), a(mesh_a, 0.5 * delta_m), b(mesh_b, 0.5 * delta_m) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  double delta_m;
  Body a, b;
};

BulletPair::BulletPair(const bake::Mesh& a, const bake::Mesh& b, double delta_m)
    : world_(std::make_unique<World>(a, b, delta_m)) {}

BulletPair::~BulletPair() = default;

BulletContacts BulletPair::contacts(const Pose& a, const Pose& b) {
  World& w = *world_;
  w.a.object.setWorldTransform(transform(a));
  w.b.object.setWorldTransform(transform(b));
  const btCollisionObjectWrapper wrap_a(nullptr, w.a.shape.get(), &w.a.object,
                                        w.a.object.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper wrap_b(nullptr, w.b.shape.get(), &w.b.object,
                                        w.b.object.getWorldTransform(), -1, -1);
  btCollisionAlgorithm* query =
      w.dispatcher.findAlgorithm(&wrap_a, &wrap_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  Counting found(&wrap_a, &wrap_b);
  query->processCollision(&wrap_a, &wrap_b, btDispatcherInfo(), &found);
  query->~btCollisionAlgorithm();
  w.dispatcher.freeCollisionAlgorithm(query);
  if (found.count == 0) return {0, std::numeric_limits<double>::quiet_NaN()};
  return {found.count, static_cast<double>(found.least) / kUnits_per_m + w.delta_m};
}

}  // namespace palpate::bench
