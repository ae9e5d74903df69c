// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/reduce.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <boost/optional.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/metrics/deviation.hpp"
#include "host_bake/metrics/nearest.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using CgalSurface = CGAL::Surface_mesh<Kernel::Point_3>;
using Quadrics = sms::GarlandHeckbert_plane_policies<CgalSurface, Kernel>;

/// A quadric's error is a sum of squared distances from planes. Up to this share of the square of
/// the deviation allowed, on detailed models between none and a twentieth of the faces go beyond
/// it.
constexpr double kShare = 10;
/// Where a larger part of the faces is bad the error is halved; where less, they are kept out of
/// it.
constexpr double kFew = 0.02;
constexpr int kAttempts = 8;

/// Ends at the first edge that is too expensive.
struct TooExpensive {
  double most;
  template <class Profile>
  bool operator()(double cost, const Profile& /*edge*/, std::size_t /*at_first*/,
                  std::size_t /*now*/) const {
    return cost > most;
  }
};

CgalSurface surface_of(const NormalMesh& mesh) {
  CgalSurface surface;
  std::vector<CgalSurface::Vertex_index> at;
  at.reserve(mesh.points.size());
  for (const auto& point : mesh.points) {
    const Vec3d p = vec(point);
    at.push_back(surface.add_vertex({p.x, p.y, p.z}));
  }
  for (const Face& f : mesh.faces) {
    if (surface.add_face(at[f[0]], at[f[1]], at[f[2]]) == CgalSurface::null_face())
      throw std::logic_error("a mesh that was let pass is no manifold");
  }
  return surface;
}

NormalMesh mesh_of(const CgalSurface& surface, const NormalMesh& original) {
  NormalMesh mesh;
  mesh.centre_m = original.centre_m;
  mesh.radius_m = original.radius_m;
  for (const auto v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    mesh.points.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  for (const auto f : surface.faces()) {
    Face face;
    std::size_t corner = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) face[corner++] = v;
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// Vertices that stay where they are, by their number in the mesh.
using Kept = std::vector<char>;

/// No collapse turns a face around or touches what is kept.
class Guard {
 public:
  explicit Guard(const Kept& kept) : kept_(&kept) {}
  template <class Profile>
  boost::optional<typename Profile::Point> operator()(
      const Profile& edge, boost::optional<typename Profile::Point> placement) const {
    if ((*kept_)[edge.v0()] != 0 || (*kept_)[edge.v1()] != 0) return {};
    return no_turns_(edge, placement);
  }

 private:
  const Kept* kept_;
  sms::Bounded_normal_change_filter<> no_turns_;
};

NormalMesh collapsed(const NormalMesh& mesh, double most_error, const Kept& kept) {
  CgalSurface surface = surface_of(mesh);
  const Quadrics quadrics(surface);
  sms::edge_collapse(surface, TooExpensive{most_error},
                     CGAL::parameters::get_cost(quadrics.get_cost())
                         .get_placement(quadrics.get_placement())
                         .filter(Guard(kept)));
  surface.collect_garbage();
  return mesh_of(surface, mesh);
}

CheckReport checked(const NormalMesh& mesh) {
  Mesh wide{.points = {}, .faces = mesh.faces};
  wide.points.reserve(mesh.points.size());
  for (const auto& point : mesh.points) {
    const Vec3d p = vec(point);
    wide.points.push_back({p.x, p.y, p.z});
  }
  return check(wide);
}

/// Of each face's points from `to`, at most.
std::vector<float> face_deviations(const NormalMesh& of, const NearestSurface& to) {
  std::vector<Patch> patches(of.faces.size());
  for (std::uint32_t f = 0; f < of.faces.size(); ++f) patches[f].faces.push_back(f);
  return surface_deviations(to, of, patches);
}

float largest(const std::vector<float>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// A part of a mesh.
NormalMesh faces_of(const NormalMesh& mesh, const std::vector<std::uint32_t>& faces) {
  NormalMesh part{.points = mesh.points, .faces = {}, .centre_m = {}, .radius_m = 1};
  for (const std::uint32_t f : faces) part.faces.push_back(mesh.faces[f]);
  return part;
}

class Reduction {
 public:
  Reduction(const NormalMesh& mesh, const CheckReport& check, double most)
      : mesh_(mesh), check_(check), most_(most), surface_(mesh), kept_(mesh.points.size(), 0) {}

  Reduced run(const Progress& progress) {
    double error = kShare * most_ * most_;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (progress) progress("reduce", static_cast<double>(attempt) / kAttempts);
      Reduced tried{.mesh = collapsed(mesh_, error, kept_), .check = {}, .deviation = 0};
      if (tried.mesh.faces.size() == mesh_.faces.size()) break;
      tried.check = checked(tried.mesh);
      const std::size_t bad = find_bad(tried);
      if (bad == 0) return tried;
      if (static_cast<double>(bad) > kFew * static_cast<double>(tried.mesh.faces.size())) {
        error /= 2;
      } else {
        keep_bad(tried.mesh, attempt);
      }
    }
    return {.mesh = mesh_, .check = check_, .deviation = 0};
  }

 private:
  /// Faces that are too far from the other surface, or cross one another and did not before.
  std::size_t find_bad(Reduced& tried) {
    const std::vector<float> to = face_deviations(tried.mesh, surface_);
    const std::vector<float> from = face_deviations(mesh_, NearestSurface(tried.mesh));
    tried.deviation = std::max(largest(to), largest(from));
    bad_of_tried_ = beyond(to);
    bad_of_mesh_ = beyond(from);
    if (tried.check.crossings > check_.crossings) {
      bad_of_tried_.insert(bad_of_tried_.end(), tried.check.crossing_faces.begin(),
                           tried.check.crossing_faces.end());
    }
    return bad_of_tried_.size() + bad_of_mesh_.size() + (tried.check.bakeable() ? 0 : 1);
  }

  [[nodiscard]] std::vector<std::uint32_t> beyond(const std::vector<float>& deviations) const {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < deviations.size(); ++f) {
      if (static_cast<double>(deviations[f]) > most_) faces.push_back(f);
    }
    return faces;
  }

  /// What bad faces have come from stays as it is, farther around them from attempt to attempt.
  void keep_bad(const NormalMesh& tried, int attempt) {
    for (const std::uint32_t f : bad_of_mesh_) {
      for (const std::uint32_t v : mesh_.faces[f]) kept_[v] = 1;
    }
    if (bad_of_tried_.empty()) return;
    const NearestSurface bad(faces_of(tried, bad_of_tried_));
    const double reach = (2 + attempt) * most_;
    for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
      if (bad.nearest(vec(mesh_.points[v])).squared_distance < reach * reach) kept_[v] = 1;
    }
  }

  const NormalMesh& mesh_;
  const CheckReport& check_;
  double most_;
  NearestSurface surface_;
  Kept kept_;
  std::vector<std::uint32_t> bad_of_tried_, bad_of_mesh_;
};

}  // namespace

Reduced reduce(const NormalMesh& mesh, const CheckReport& check, double max_deviation,
               const Progress& progress) {
  return Reduction(mesh, check, max_deviation).run(progress);
}

}  // namespace palpate::bake
