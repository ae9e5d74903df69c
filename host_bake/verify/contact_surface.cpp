// SPDX-License-Identifier: GPL-3.0-or-later
// What contacts see of the surface against its triangles: vertices, normals, edges, cones.
#include "rt_core/contact/surface.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/surface_edge.hpp"
#include "host_bake/verify/proofs.hpp"
#include "rt_core/image/triangle_normal.hpp"

namespace palpate::bake {
namespace {

// A component of a unit vector is off by half a unit of the last place at 1 when it is rounded to
// float, 2^-25; three of them by 5.2e-8.
constexpr double kStored = 6e-8;

// The sine between normals that count as one (image::kEqualNormalCos): 1.4e-5.
const double kDistinct = std::sqrt(2 * (1 - image::kEqualNormalCos));

// How far a face's normal may be outside of the hull: kDistinct from the normal that it counts as,
// as much again where that one stood out by less and was left out, and a third of that where its
// neighbours were left out afterwards: corners that stand out alike stand out by a quarter of it
// before every other one has gone.
const double kOutsideHull = 3 * kDistinct + kStored;

// Sums of normals by angles are off by 2^-53 of at most 2 pi for each face, of which some tens
// meet.
constexpr double kSumRounding = 1e-13;
constexpr double kCancelled = 1e-9;  // a shorter sum has no direction

// Cones are rounded down by 1e-6; axis and cosine are then rounded to float.
constexpr double kConeTooWide = 1e-6 + 2 * kStored;

// Normals all within less than a half space by this are in a half space for the baker too, which
// finds a cone at least as narrow as the one about their mean, and counts it down to 1e-4.
constexpr double kHalfSpaceCosine = 1e-3;

bool has_surface(const ImageView& image) { return !image.surface_vertices.empty(); }

Proof no_regions(const std::string& invariant) { return {invariant, true, "no regions"}; }

/// Corners at each vertex, 3 * triangle + corner, ascending.
class CornersAtVertices {
 public:
  explicit CornersAtVertices(const ImageView& image)
      : starts_(image.surface_vertices.size() + 1, 0), names_(3 * image.triangle_vertices.size()) {
    for (const image::TriangleVertices& t : image.triangle_vertices) {
      for (const std::uint32_t v : t.corner) ++starts_[v + 1];
    }
    for (std::size_t v = 1; v < starts_.size(); ++v) starts_[v] += starts_[v - 1];
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t name = 0; name < names_.size(); ++name) {
      names_[next[image.triangle_vertices[name / 3].corner[name % 3]]++] = name;
    }
  }

  [[nodiscard]] std::span<const std::uint32_t> at(std::uint32_t vertex) const {
    return std::span(names_).subspan(starts_[vertex], starts_[vertex + 1] - starts_[vertex]);
  }

 private:
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> names_;
};

template <class Check>
Proof prove_each_vertex(const std::string& invariant, const ImageView& image, Check check) {
  if (!has_surface(image)) return no_regions(invariant);
  const CornersAtVertices corners(image);
  return prove_each(invariant, Things{image.surface_vertices.size(), "vertex", "vertices"},
                    [&](std::uint32_t v) { return check(v, corners.at(v)); });
}

/// Normals of the faces that have one.
std::vector<Vec3d> face_normals(const ImageView& image, std::span<const std::uint32_t> corners) {
  std::vector<Vec3d> out;
  for (const std::uint32_t name : corners) {
    const Vec3d normal = image::normal_of(image.region_triangles[name / 3]);
    if (!(normal == Vec3d{})) out.push_back(normal);
  }
  return out;
}

std::vector<Vec3d> directions(std::span<const image::SurfaceNormal> stored) {
  std::vector<Vec3d> out;
  for (const image::SurfaceNormal& n : stored) out.push_back(vec3d(n.xyz));
  return out;
}

bool has_near(std::span<const Vec3d> among, Vec3d n, double distance) {
  return std::ranges::any_of(among, [&](const Vec3d& m) { return norm(m - n) <= distance; });
}

/// Whether the mean of the normals shows that they are in less than a half space.
bool in_half_space(std::span<const Vec3d> normals) {
  Vec3d sum{};
  for (const Vec3d& n : normals) sum += n;
  const Vec3d mean = unit(sum);
  return !normals.empty() && std::ranges::all_of(normals, [&](const Vec3d& n) {
    return dot(n, mean) > kHalfSpaceCosine;
  });
}

// --- vertices ---

/// Region of each vertex; none where the runs do not follow one another to the last vertex.
std::vector<std::uint32_t> regions_of_vertices(const ImageView& image) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t r = 0; r < image.surface_runs.size(); ++r) {
    const image::SurfaceRun& run = image.surface_runs[r];
    const std::size_t left = image.surface_vertices.size() - out.size();
    if (run.first_vertex != out.size() || run.vertices > left) return {};
    out.resize(out.size() + run.vertices, r);
  }
  if (out.size() != image.surface_vertices.size()) return {};
  return out;
}

std::string off_its_corner(const ImageView& image, std::uint32_t vertex, std::uint32_t name) {
  const image::RegionTriangle& t = image.region_triangles[name / 3];
  const auto* position = image.surface_vertices[vertex].position;
  if (std::equal(position, position + 3, t.corners + std::size_t{3} * (name % 3))) return {};
  return "not at corner " + std::to_string(name % 3) + " of triangle " + std::to_string(name / 3);
}

// The edge from this corner has the same two vertices on its other side.
std::string not_shared(const ImageView& image, std::uint32_t name) {
  const auto& mine = image.triangle_vertices[name / 3].corner;
  const std::uint32_t across = image.region_triangles[name / 3].neighbours[name % 3];
  if (across == image::kNone) return {};
  const auto& other = image.triangle_vertices[across].corner;
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (other[k] == mine[(name + 1) % 3] && other[(k + 1) % 3] == mine[name % 3]) return {};
  }
  return "triangle " + std::to_string(across) + " has other vertices at the edge from it";
}

std::string wrong_vertex(const ImageView& image, std::uint32_t region, std::uint32_t vertex,
                         std::span<const std::uint32_t> corners) {
  if (corners.empty()) return "of no triangle";
  if (image.region_triangles[corners[0] / 3].region != region) {
    return "not in the run of its first triangle's region";
  }
  for (const std::uint32_t name : corners) {
    const std::string wrong = off_its_corner(image, vertex, name) + not_shared(image, name);
    if (!wrong.empty()) return wrong;
  }
  return {};
}

// --- hulls ---

// The engine takes a direction for one of the hull where it is on the left of all arcs: so are the
// corners, hence all between them. To the rounding of the products.
bool turns_left(std::span<const Vec3d> hull) {
  constexpr double kRounding = 1e-15;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec3d across = cross(hull[i], hull[(i + 1) % hull.size()]);
    const auto right = [&](const Vec3d& n) { return dot(n, across) < -kRounding; };
    if (std::ranges::any_of(hull, right)) return false;
  }
  return true;
}

/// How far a normal is outside of a hull that turns left, rad; small angles. Lengths of differences
/// tell what cosines of stored normals, which are off by kStored, do not.
double outside_hull(std::span<const Vec3d> hull, Vec3d n) {
  bool inside = hull.size() > 2;
  double least = norm(hull[0] - n);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec3d& from = hull[i];
    const Vec3d& to = hull[(i + 1) % hull.size()];
    const Vec3d pole = unit(cross(from, to));
    const double beyond = -dot(n, pole);
    inside = inside && beyond <= 0;
    least = std::min(least, norm(from - n));
    const bool beside = dot(n, cross(pole, from)) >= 0 && dot(n, cross(to, pole)) >= 0;
    if (beside && hull.size() > 1) least = std::min(least, std::abs(beyond));
  }
  return inside ? 0 : least;
}

std::string wrong_hull(const ImageView& image, std::uint32_t vertex,
                       std::span<const std::uint32_t> corners) {
  const image::SurfaceVertex& v = image.surface_vertices[vertex];
  const std::vector<Vec3d> normals = face_normals(image, corners);
  if (v.hull_normals == 0) {
    return in_half_space(normals) ? "no hull, but its normals lie in a half space" : "";
  }
  const auto hull = directions(image.vertex_normals.subspan(v.first_normal, v.hull_normals));
  for (const Vec3d& corner : hull) {
    if (!has_near(normals, corner, kStored)) return "a corner of its hull is no face's normal";
  }
  if (hull.size() > 2 && !turns_left(hull)) return "its hull is not convex, or turns right";
  double most = 0;
  for (const Vec3d& n : normals) most = std::max(most, outside_hull(hull, n));
  if (most <= kOutsideHull) return {};
  return "a face's normal is " + std::to_string(most) + " rad outside its hull";
}

// --- pseudonormals ---

double angle_at(const ImageView& image, std::uint32_t name) {
  const image::RegionTriangle& t = image.region_triangles[name / 3];
  const Vec3d p = image::corner_of(t, name % 3);
  const Vec3d a = image::corner_of(t, (name + 1) % 3) - p;
  const Vec3d b = image::corner_of(t, (name + 2) % 3) - p;
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Triangles that cross others are patches of their own, of which the back may be reached.
bool may_cross(const ImageView& image, std::uint32_t name) {
  const image::Piece& piece = image.pieces[image.region_triangles[name / 3].piece];
  const auto back_open = static_cast<std::uint32_t>(image::PieceFlag::back_open);
  return (piece.flags & back_open) != 0 && piece.triangles == 1;
}

bool on_border(const ImageView& image, std::uint32_t name) {
  const auto& across = image.region_triangles[name / 3].neighbours;
  return across[name % 3] == image::kNone || across[(name + 2) % 3] == image::kNone;
}

std::string wrong_pseudonormal(const ImageView& image, std::uint32_t vertex,
                               std::span<const std::uint32_t> corners) {
  const Vec3d stored = vec3d(image.surface_vertices[vertex].pseudonormal);
  const bool border =
      std::ranges::any_of(corners, [&](std::uint32_t name) { return on_border(image, name); });
  if (border) return stored == Vec3d{} ? "" : "has a pseudonormal on a border";
  const bool crossing =
      std::ranges::any_of(corners, [&](std::uint32_t name) { return may_cross(image, name); });
  if (crossing && stored == Vec3d{}) return {};
  Vec3d sum{};
  for (const std::uint32_t name : corners) {
    sum += angle_at(image, name) * image::normal_of(image.region_triangles[name / 3]);
  }
  const double length = norm(sum);
  if (stored == Vec3d{}) {
    return length <= kCancelled + kSumRounding ? "" : "has no pseudonormal, but no border either";
  }
  if (length < kCancelled - kSumRounding) return "has a pseudonormal, but its normals cancel";
  const double off = norm(unit(sum) - stored);
  if (off <= kStored + kSumRounding / length) return {};
  return "its pseudonormal is off by " + std::to_string(off);
}

// --- concave normals ---

/// Normals of the faces at a vertex beside one of its concave edges.
std::vector<Vec3d> beside_concave(const ImageView& image, std::span<const std::uint32_t> corners) {
  std::vector<Vec3d> out;
  const auto is_concave = [&](std::uint32_t side) {
    return bend_of(image.region_triangles, side) == Bend::concave;
  };
  for (const std::uint32_t name : corners) {
    const std::uint32_t before = name - name % 3 + (name + 2) % 3;  // the side that ends here
    if (is_concave(name) || is_concave(before)) {
      out.push_back(image::normal_of(image.region_triangles[name / 3]));
    }
  }
  return out;
}

std::string wrong_concave_normals(const ImageView& image, std::uint32_t vertex,
                                  std::span<const std::uint32_t> corners) {
  const std::vector<Vec3d> expected = beside_concave(image, corners);
  const auto stored = directions(contact::concave_normals({&image, 1}, vertex));
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (!has_near(expected, stored[i], kStored)) return "a concave normal is no such face's";
    if (has_near(std::span(stored).first(i), stored[i], kDistinct - 2 * kStored)) {
      return "two of its concave normals are one";
    }
  }
  for (const Vec3d& n : expected) {
    if (!has_near(stored, n, kDistinct + kStored)) return "a concave normal is missing";
  }
  return {};
}

// --- edges ---

std::vector<std::vector<std::uint32_t>> convex_edges(const ImageView& image) {
  std::vector<std::vector<std::uint32_t>> of_region(image.surface_runs.size());
  for (std::uint32_t side = 0; side < 3 * image.region_triangles.size(); ++side) {
    const image::RegionTriangle& t = image.region_triangles[side / 3];
    const std::uint32_t across = t.neighbours[side % 3];
    if (across == image::kNone || across < side / 3) continue;
    if (bend_of(image.region_triangles, side) == Bend::convex) of_region[t.region].push_back(side);
  }
  return of_region;
}

// --- cones ---

std::vector<std::vector<Vec3d>> normals_of_regions(const ImageView& image) {
  std::vector<std::vector<Vec3d>> out(image.surface_runs.size());
  for (const image::RegionTriangle& t : image.region_triangles) {
    const Vec3d normal = image::normal_of(t);
    if (!(normal == Vec3d{})) out[t.region].push_back(normal);
  }
  return out;
}

std::string wrong_cone(const image::SurfaceRun& run, std::span<const Vec3d> normals) {
  const Vec3d axis = vec3d(run.normal);
  const auto cosine = static_cast<double>(run.normal_cos);
  if (axis == Vec3d{}) {
    if (cosine != -1) return "a cone without an axis";
    return in_half_space(normals) ? "no cone, but its normals lie in a half space" : "";
  }
  double least = 1;
  for (const Vec3d& n : normals) least = std::min(least, dot(n, axis));
  if (least < cosine) return "a normal is outside its cone";
  return least - cosine <= kConeTooWide ? "" : "its cone is wider than its normals";
}

}  // namespace

Proof prove_surface_vertices(const Evidence& evidence) {
  const std::string invariant = "surface vertices are those of the triangles";
  const ImageView& image = evidence.image;
  const std::vector<std::uint32_t> regions = regions_of_vertices(image);
  if (has_surface(image) && regions.empty()) return {invariant, false, "the regions' runs are off"};
  return prove_each_vertex(invariant, image,
                           [&](std::uint32_t v, std::span<const std::uint32_t> corners) {
                             return wrong_vertex(image, regions[v], v, corners);
                           });
}

Proof prove_vertex_hulls(const Evidence& evidence) {
  return prove_each_vertex("hulls of normals hold those of the faces", evidence.image,
                           [&](std::uint32_t v, std::span<const std::uint32_t> corners) {
                             return wrong_hull(evidence.image, v, corners);
                           });
}

Proof prove_pseudonormals(const Evidence& evidence) {
  return prove_each_vertex("pseudonormals are the means of the faces' normals", evidence.image,
                           [&](std::uint32_t v, std::span<const std::uint32_t> corners) {
                             return wrong_pseudonormal(evidence.image, v, corners);
                           });
}

Proof prove_concave_normals(const Evidence& evidence) {
  return prove_each_vertex("concave normals are those beside concave edges", evidence.image,
                           [&](std::uint32_t v, std::span<const std::uint32_t> corners) {
                             return wrong_concave_normals(evidence.image, v, corners);
                           });
}

Proof prove_surface_edges(const Evidence& evidence) {
  const std::string invariant = "listed edges are the convex ones";
  const ImageView& image = evidence.image;
  if (!has_surface(image)) return no_regions(invariant);
  const auto expected = convex_edges(image);
  std::size_t next = 0;
  for (std::size_t r = 0; r < expected.size(); ++r) {
    const image::SurfaceRun& run = image.surface_runs[r];
    const bool follows = run.first_edge == next && run.edges <= image.surface_edges.size() - next;
    if (!follows) return {invariant, false, "region " + std::to_string(r) + ": its run is off"};
    if (!std::ranges::equal(image.surface_edges.subspan(next, run.edges), expected[r])) {
      return {invariant, false, "region " + std::to_string(r) + ": its convex edges are others"};
    }
    next += run.edges;
  }
  if (next != image.surface_edges.size()) return {invariant, false, "edges of no region"};
  return {invariant, true, std::to_string(next) + " edges"};
}

Proof prove_region_cones(const Evidence& evidence) {
  const std::string invariant = "cones of regions hold their normals";
  const ImageView& image = evidence.image;
  if (!has_surface(image)) return no_regions(invariant);
  const auto normals = normals_of_regions(image);
  return prove_each(invariant, Things{image.surface_runs.size(), "region", "regions"},
                    [&](std::uint32_t r) { return wrong_cone(image.surface_runs[r], normals[r]); });
}

}  // namespace palpate::bake
