// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "hull_oracle.hpp"
#include "oracle_vec.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::test {
namespace {

using bake::Face;
using bake::HullMesh;
using bake::NormalMesh;
using bake::Patch;
using bake::PointF;
using Triple = std::array<std::uint32_t, 3>;

constexpr long double kShrink = 1e-7L;

class Judge {
 public:
  Judge(const NormalMesh& mesh, const bake::CheckReport& report, const std::vector<Patch>& patches,
        bool connected)
      : mesh_(mesh),
        report_(report),
        patches_(patches),
        connected_(connected),
        patch_of_(mesh.faces.size(), kNone) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) by_x_.push_back(f);
    std::sort(by_x_.begin(), by_x_.end(), [&](auto a, auto b) { return low_x(a) < low_x(b); });
    for (const std::uint32_t f : by_x_) widest_ = std::max(widest_, high_x(f) - low_x(f));
    for (const Face& t : mesh.faces) area_.push_back(in_line(at(t[0]), at(t[1]), at(t[2])) ? 0 : 1);
    for (const std::size_t f : report.crossing_faces) crossing_.insert(f);
    for (const std::size_t f : crossing_) unsound_.insert(report.face_component[f]);
  }

  std::string run() {
    for (std::uint32_t p = 0; p < patches_.size(); ++p) {
      for (const std::uint32_t f : patches_[p].faces) {
        if (patch_of_[f] != kNone) return "face " + std::to_string(f) + " is in two patches";
        patch_of_[f] = p;
      }
    }
    for (const std::uint32_t p : patch_of_)
      if (p == kNone) return "a face is in no patch";
    for (std::uint32_t p = 0; p < patches_.size(); ++p) {
      const std::string wrong = judge(p);
      if (!wrong.empty())
        return "patch " + std::to_string(p) + " of " + std::to_string(patches_[p].faces.size()) +
               " faces from " + std::to_string(patches_[p].faces.front()) + ": " + wrong;
    }
    return {};
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  float low_x(std::uint32_t f) const { return extent(f, 0).first; }
  float high_x(std::uint32_t f) const { return extent(f, 0).second; }
  std::pair<float, float> extent(std::uint32_t f, std::size_t axis) const {
    return std::minmax(
        {at(mesh_.faces[f][0])[axis], at(mesh_.faces[f][1])[axis], at(mesh_.faces[f][2])[axis]});
  }
  const PointF& at(std::uint32_t v) const { return mesh_.points[v]; }
  Vec corner(std::uint32_t f, std::size_t i) const { return vec(at(mesh_.faces[f][i])); }
  bool has_area(std::uint32_t f) const { return area_[f] != 0; }
  int side_of_face(std::uint32_t f, std::uint32_t v) const {
    const Face& t = mesh_.faces[f];
    return exact_side(at(t[0]), at(t[1]), at(t[2]), at(v));
  }

  std::string judge(std::uint32_t p) {
    const Patch& patch = patches_[p];
    for (const auto& part :
         {judge_lists(patch), judge_flags(patch), judge_edges(patch), judge_planes(patch)})
      if (!part.empty()) return part;
    std::vector<PointF> points;
    for (const std::uint32_t v : patch.vertices) points.push_back(at(v));
    HullMesh hull = patch.hull;
    const std::string wrong = judge_hull(points, hull);
    if (!wrong.empty()) return wrong;
    points_.clear();
    for (const PointF& q : points) points_.push_back(vec(q));
    const std::string cover = judge_cover(patch);
    if (!cover.empty()) return cover;
    return hull.dimension == 3 ? judge_interior(p, patch) : std::string();
  }

  std::string judge_lists(const Patch& patch) const {
    if (patch.faces.empty()) return "no faces";
    if (!std::is_sorted(patch.faces.begin(), patch.faces.end())) return "faces not ascending";
    std::set<std::uint32_t> expected;
    for (const std::uint32_t f : patch.faces)
      expected.insert(mesh_.faces[f].begin(), mesh_.faces[f].end());
    const std::set<std::uint32_t> listed(patch.vertices.begin(), patch.vertices.end());
    if (listed != expected || listed.size() != patch.vertices.size()) return "wrong vertices";
    for (std::size_t i = 0; i < patch.hull.vertices.size(); ++i)
      if (patch.hull.vertices[i] != i) return "hull vertices do not come first";
    const auto others =
        patch.vertices.begin() + static_cast<std::ptrdiff_t>(patch.hull.vertices.size());
    if (!std::is_sorted(patch.vertices.begin(), others) ||
        !std::is_sorted(others, patch.vertices.end()))
      return "vertices not ascending";
    return {};
  }

  std::string judge_flags(const Patch& patch) const {
    const std::uint32_t component = report_.face_component[patch.faces[0]];
    const bool back_open = report_.component_closed[component] == 0 || unsound_.contains(component);
    if (patch.back_open != back_open) return "wrong back_open";
    if (back_open && patch.faces.size() > image::kMaxOpenPatchTriangles)
      return "too large for its back";
    for (const std::uint32_t f : patch.faces)
      if (crossing_.contains(f) && patch.faces.size() > 1) return "a crossing face has company";
    if (patch.all_real != patch.virtual_faces.empty()) return "wrong all_real";
    return {};
  }

  /// Constraint 1, and that the faces hang together.
  std::string judge_edges(const Patch& patch) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_at;
    for (const std::uint32_t f : patch.faces)
      for (std::size_t i = 0; i < 3; ++i)
        face_at[{mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3]}] = f;
    std::map<std::uint32_t, std::vector<std::uint32_t>> next_to;
    for (const auto& [edge, f] : face_at) {
      const auto other = face_at.find({edge.second, edge.first});
      if (other == face_at.end()) continue;
      next_to[f].push_back(other->second);
      if (!has_area(f)) continue;
      for (const std::uint32_t v : mesh_.faces[other->second])
        if (side_of_face(f, v) > 0) return "reflex edge inside";
    }
    std::set<std::uint32_t> reached = {patch.faces[0]};
    std::vector<std::uint32_t> stack = {patch.faces[0]};
    while (!stack.empty()) {
      const std::uint32_t f = stack.back();
      stack.pop_back();
      for (const std::uint32_t g : next_to[f])
        if (reached.insert(g).second) stack.push_back(g);
    }
    return !connected_ || reached.size() == patch.faces.size() ? "" : "not connected";
  }

  /// Constraint 2.
  std::string judge_planes(const Patch& patch) const {
    for (const std::uint32_t f : patch.faces)
      if (has_area(f))
        for (const std::uint32_t v : patch.vertices)
          if (side_of_face(f, v) > 0) return "a vertex sees a face";
    return {};
  }

  bool covered(const Patch& patch, Vec p) const {
    return std::any_of(patch.faces.begin(), patch.faces.end(), [&](std::uint32_t f) {
      return distance(p, corner(f, 0), corner(f, 1), corner(f, 2)) < 2 * kShrink;
    });
  }

  Vec sample(Vec a, Vec b, Vec c) {
    std::uniform_real_distribution<long double> share(0, 1);
    long double u = share(random_);
    long double v = share(random_);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return a + u * (b - a) + v * (c - a);
  }

  /// Hull faces that are not virtual are covered by the patch; of a facet with virtual faces some
  /// part is not.
  std::string judge_cover(const Patch& patch) {
    const std::set<Triple> hidden(patch.virtual_faces.begin(), patch.virtual_faces.end());
    std::set<Triple> unknown = hidden;
    for (const Triple& face : patch.hull.faces) {
      unknown.erase(face);
      if (hidden.contains(face)) continue;
      for (int i = 0; i < 6; ++i)
        if (!covered(patch, sample(points_[face[0]], points_[face[1]], points_[face[2]])))
          return "a face called real is not covered";
    }
    if (!unknown.empty()) return "a virtual face is not of the hull";
    if (patch.hull.dimension != 3) return hidden.empty() ? "" : "a flat patch has virtual faces";
    for (const Triple& face : hidden)
      if (!partly_open(patch, face)) return "a face called virtual is covered";
    return {};
  }

  /// Of the hull's facet in the plane of `face` some point is not covered, or the patch's faces in
  /// that plane lack area (a slit too narrow to hit).
  bool partly_open(const Patch& patch, const Triple& face) {
    const auto in_plane = [&](const Triple& mesh_vertices) {
      return std::all_of(mesh_vertices.begin(), mesh_vertices.end(), [&](std::uint32_t v) {
        return exact_side(at(patch.vertices[face[0]]), at(patch.vertices[face[1]]),
                          at(patch.vertices[face[2]]), at(v)) == 0;
      });
    };
    const auto twice_area = [](Vec a, Vec b, Vec c) { return length(cross(b - a, c - a)); };
    const Plane plane = plane_of(points_[face[0]], points_[face[1]], points_[face[2]]);
    long double total = 0;
    for (const Triple& f : patch.hull.faces) {
      if (!in_plane({patch.vertices[f[0]], patch.vertices[f[1]], patch.vertices[f[2]]})) continue;
      for (int i = 0; i < 40; ++i)
        if (!covered_in_plane(patch, plane, sample(points_[f[0]], points_[f[1]], points_[f[2]])))
          return true;
      total += twice_area(points_[f[0]], points_[f[1]], points_[f[2]]);
    }
    long double missing = total;
    for (const std::uint32_t f : patch.faces)
      if (in_plane(mesh_.faces[f])) missing -= twice_area(corner(f, 0), corner(f, 1), corner(f, 2));
    return missing > 1e-10L * total;
  }

  bool covered_in_plane(const Patch& patch, const Plane& plane, Vec p) const {
    return std::any_of(patch.faces.begin(), patch.faces.end(), [&](std::uint32_t f) {
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(dot(plane.normal, corner(f, i)) - plane.offset) > 1e-13L) return false;
      return distance(p, corner(f, 0), corner(f, 1), corner(f, 2)) < 1e-12L;
    });
  }

  /// Constraint 3.
  std::string judge_interior(std::uint32_t p, const Patch& patch) {
    std::vector<Plane> planes;
    long double width = std::numeric_limits<long double>::max();
    for (const Triple& face : patch.hull.faces) {
      planes.push_back(plane_of(points_[face[0]], points_[face[1]], points_[face[2]]));
      long double depth = 0;
      for (const Vec& v : points_)
        depth = std::max(depth, planes.back().offset - dot(planes.back().normal, v));
      width = std::min(width, depth);
    }
    if (width < 2 * kShrink) return judge_thin(patch);
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const std::uint32_t v : patch.vertices)
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], at(v)[i]);
        high[i] = std::max(high[i], at(v)[i]);
      }
    auto f = std::lower_bound(by_x_.begin(), by_x_.end(), low[0] - widest_,
                              [&](std::uint32_t face, float x) { return low_x(face) < x; });
    for (; f != by_x_.end() && low_x(*f) <= high[0]; ++f) {
      bool apart = patch_of_[*f] == p;
      for (std::size_t i = 0; i < 3; ++i)
        apart = apart || extent(*f, i).first > high[i] || extent(*f, i).second < low[i];
      if (!apart && enters(*f, planes)) return "face " + std::to_string(*f) + " enters the hull";
    }
    return {};
  }

  bool enters(std::uint32_t f, const std::vector<Plane>& planes) const {
    std::vector<Vec> polygon = {corner(f, 0), corner(f, 1), corner(f, 2)};
    for (const Plane& plane : planes) {
      std::vector<Vec> kept;
      const auto above = [&](Vec v) {
        return dot(plane.normal, v) - plane.offset + 1.001L * kShrink;
      };
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec a = polygon[i];
        const Vec b = polygon[(i + 1) % polygon.size()];
        if (above(a) <= 0) kept.push_back(a);
        if ((above(a) > 0) != (above(b) > 0))
          kept.push_back(a + (above(a) / (above(a) - above(b))) * (b - a));
      }
      polygon = kept;
      if (polygon.empty()) return false;
    }
    return true;
  }

  /// A hull without interior: every mix of its vertices is near the patch.
  std::string judge_thin(const Patch& patch) {
    std::uniform_real_distribution<long double> share(0, 1);
    for (int i = 0; i < 200; ++i) {
      Vec p;
      long double total = 0;
      for (std::size_t v = 0; v < patch.hull.vertices.size(); ++v) {
        const long double w = std::pow(share(random_), 8.0L);
        p = p + w * points_[v];
        total += w;
      }
      p = (1 / total) * p;
      const bool near = std::any_of(patch.faces.begin(), patch.faces.end(), [&](std::uint32_t f) {
        return distance(p, corner(f, 0), corner(f, 1), corner(f, 2)) < 6 * kShrink;
      });
      if (!near) return "a thin hull leaves its patch";
    }
    return {};
  }

  const NormalMesh& mesh_;
  const bake::CheckReport& report_;
  const std::vector<Patch>& patches_;
  const bool connected_;
  std::vector<std::uint32_t> patch_of_, by_x_;
  float widest_ = 0;
  std::vector<char> area_;
  std::set<std::size_t> crossing_;
  std::set<std::uint32_t> unsound_;
  std::vector<Vec> points_;  // of the patch at hand
  std::mt19937 random_{1};
};

}  // namespace

std::string judge_patches(const NormalMesh& mesh, const bake::CheckReport& report,
                          const std::vector<Patch>& patches, bool connected) {
  return Judge(mesh, report, patches, connected).run();
}

}  // namespace palpate::test
