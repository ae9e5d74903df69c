// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/contact_oracle.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace palpate::test {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Surface = OracleSurface;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = 0xffffffffu;

Point to_cgal(Vec3d p) { return {p.x, p.y, p.z}; }
double clamp01(double x) { return std::clamp(x, 0.0, 1.0); }
Vec3d unit(Vec3d v) { return norm(v) > 0 ? (1 / norm(v)) * v : Vec3d{}; }
Eigen::Vector3d to_eigen(Vec3d v) { return {v.x, v.y, v.z}; }

// --- the least push ---

/// Least squares of A x - b with x >= 0 (Lawson and Hanson 1974, ch. 23).
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
  std::vector<Eigen::Index> free;
  Eigen::Index refused = -1;  // it would have become negative at once, by rounding
  for (int step = 0; step < 1000; ++step) {
    const Eigen::VectorXd slope = a.transpose() * (b - a * x);
    Eigen::Index enters = -1;
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
      if (x[i] > 0 || i == refused || slope[i] < 1e-13) continue;
      if (enters < 0 || slope[i] > slope[enters]) enters = i;
    }
    if (enters < 0) break;
    free.push_back(enters);
    refused = -1;
    while (!free.empty()) {
      const Eigen::VectorXd y = a(Eigen::all, free).colPivHouseholderQr().solve(b);
      double share = 1;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const double now = x[free[i]];
        if (y[Eigen::Index(i)] <= 0) share = std::min(share, now / (now - y[Eigen::Index(i)]));
      }
      if (y[Eigen::Index(free.size()) - 1] <= 0 && x[enters] == 0) {
        refused = enters;
        free.pop_back();
        break;
      }
      for (std::size_t i = 0; i < free.size(); ++i) {
        double& now = x[free[i]];
        now += share * (y[Eigen::Index(i)] - now);
        if (y[Eigen::Index(i)] <= 0 && now < 1e-15) now = 0;
      }
      if (share == 1) break;
      std::erase_if(free, [&](Eigen::Index i) { return x[i] == 0; });
    }
  }
  return x;
}

struct Constraint {
  Vec3d normal{};
  double strength = 0;
};

using Vector9 = Eigen::Matrix<double, 9, 1>;

/// n.v + n.S n is the product of this and (v, S), whose own square is |v|^2 + |S|^2.
Vector9 row_of(Vec3d n) {
  const double r = std::numbers::sqrt2;
  Vector9 out;
  out << n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.z * n.z, r * n.x * n.y, r * n.y * n.z,
      r * n.z * n.x;
  return out;
}

struct LeastPush {
  Vector9 push = Vector9::Zero();  ///< (v, S)
  std::vector<double> multipliers;
  [[nodiscard]] double along(Vec3d n) const { return row_of(n).dot(push); }
  [[nodiscard]] Vec3d vector() const { return {push[0], push[1], push[2]}; }
};

/// Sec. 4, as a problem of least distance (Lawson and Hanson 1974, ch. 23, Sec. 4).
LeastPush least_push(const std::vector<Constraint>& constraints) {
  LeastPush out;
  out.multipliers.assign(constraints.size(), 0);
  double most = 0;
  for (const Constraint& c : constraints) most = std::max(most, c.strength);
  if (!(most > 0)) return out;
  Eigen::MatrixXd rows(10, constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    rows.col(Eigen::Index(i)) << row_of(constraints[i].normal), constraints[i].strength / most;
  }
  const Eigen::VectorXd one = Eigen::VectorXd::Unit(10, 9);
  const Eigen::VectorXd u = nonnegative_least_squares(rows, one);
  const Eigen::VectorXd left = one - rows * u;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    out.multipliers[i] = most * u[Eigen::Index(i)] / left[9];
  }
  out.push = -most / left[9] * left.head<9>();
  return out;
}

// --- directions (Sec. 1) ---

struct Nearest {
  Vec3d normal{};   ///< pi(u, N)
  double cosine{};  ///< of ang(u, N)
};

Nearest nearest(Vec3d u, const std::vector<Vec3d>& normals) {
  Nearest out{{}, -2};
  for (const Vec3d& n : normals) {
    if (dot(u, n) > out.cosine) out = {n, dot(u, n)};
  }
  if (normals.size() < 2) return out;
  // Within a right angle it is the projection on the cone of the normals.
  Eigen::MatrixXd columns(3, normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    columns.col(Eigen::Index(i)) = to_eigen(normals[i]);
  }
  const Eigen::Vector3d p = columns * nonnegative_least_squares(columns, to_eigen(u));
  const Vec3d projected{p[0], p[1], p[2]};
  constexpr double kRightAngle = 1e-9;  // the projection is 0 there and beyond
  if (norm(projected) > std::max(out.cosine, kRightAngle)) {
    out = {unit(projected), norm(projected)};
  }
  return out;
}

double f(double cosine) {
  return clamp01(1 - std::acos(std::clamp(cosine, -1.0, 1.0)) / (std::numbers::pi / 4));
}

/// c of Sec. 1.
double directness(double depth, double length) {
  return length > 0 ? clamp01((3 * depth / length - 1) / 2) : 1;
}

/// r of Sec. 1.
double within_reach(double distance, double delta) {
  return clamp01((1.25 - distance / delta) / 0.25);
}

// --- closest points ---

/// The closest point y of a triangle.
struct Foot {
  Vec3d point{};
  double distance = kInfinity;
  std::uint32_t triangle = kNone;
  int corner = -1;  ///< where y is a corner
  int side = -1;    ///< where it is on an edge
};

Foot closest(const Surface& s, std::uint32_t triangle, Vec3d x) {
  Foot out;
  out.triangle = triangle;
  const auto& t = s.triangles[triangle];
  const auto corner = [&](int i) { return s.vertices[t.corner[std::size_t(i % 3)]].position; };
  const Vec3d above = x - dot(x - corner(0), t.normal) * t.normal;
  bool inside = true;
  for (int i = 0; i < 3; ++i) {
    const Vec3d from = corner(i), along = corner(i + 1) - from;
    inside = inside && dot(cross(along, above - from), t.normal) > 0;
  }
  if (inside) {
    out.point = above;
    out.distance = norm(x - above);
    return out;
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3d from = corner(i), along = corner(i + 1) - from;
    const double share = dot(x - from, along) / squared_norm(along);
    const Vec3d at = share <= 0 ? from : share >= 1 ? corner(i + 1) : from + share * along;
    if (norm(x - at) >= out.distance) continue;
    out.point = at;
    out.distance = norm(x - at);
    out.corner = share <= 0 ? i : share >= 1 ? (i + 1) % 3 : -1;
    out.side = out.corner < 0 ? i : -1;
  }
  return out;
}

std::vector<Vec3d> normals_at(const Surface& s, const Foot& foot) {
  const auto& t = s.triangles[foot.triangle];
  if (foot.corner >= 0) return s.vertices[t.corner[std::size_t(foot.corner)]].normals;
  if (foot.side < 0) return {t.normal};
  std::vector<Vec3d> out;
  for (const std::uint32_t face : s.edges[t.edge[std::size_t(foot.side)]].faces) {
    if (norm(s.triangles[face].normal) > 0) out.push_back(s.triangles[face].normal);
  }
  return out;
}

Vec3d pseudonormal_at(const Surface& s, const Foot& foot) {
  const auto& t = s.triangles[foot.triangle];
  if (foot.corner >= 0) return s.vertices[t.corner[std::size_t(foot.corner)]].pseudonormal;
  if (t.crosses) return {};
  if (foot.side < 0) return t.normal;
  const auto& faces = s.edges[t.edge[std::size_t(foot.side)]].faces;
  Vec3d sum{};
  for (const std::uint32_t face : faces) {
    if (s.triangles[face].crosses) return {};
    sum += s.triangles[face].normal;
  }
  return faces.size() == 2 ? sum : Vec3d{};
}

}  // namespace

struct OracleSurface::Tree {
  struct Primitive {
    using Id = std::uint32_t;
    using Point = Kernel::Point_3;
    using Datum = Kernel::Triangle_3;
    using Datum_reference = const Datum&;
    Id triangle = 0;
    Datum corners;
    [[nodiscard]] Id id() const { return triangle; }
    [[nodiscard]] Datum_reference datum() const { return corners; }
    [[nodiscard]] Point reference_point() const { return corners.vertex(0); }
  };
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> boxes;

  [[nodiscard]] std::vector<std::uint32_t> in_box(Vec3d centre, double half) const {
    const Vec3d r{half, half, half};
    return between(centre - r, centre + r);
  }
  [[nodiscard]] std::vector<std::uint32_t> between(Vec3d least, Vec3d most) const {
    std::vector<std::uint32_t> out;
    boxes.all_intersected_primitives(Kernel::Iso_cuboid_3(to_cgal(least), to_cgal(most)),
                                     std::back_inserter(out));
    return out;
  }
};

namespace {

/// Borders and crossing faces meet there. Read from the image: that the baker finds them is tested
/// elsewhere.
bool has_no_inside(const ImageView& image, std::uint32_t vertex) {
  return norm(vec3d(image.surface_vertices[vertex].pseudonormal)) == 0;
}

bool has(const ImageView& image, image::HeaderFlag flag) {
  return (image.header->flags & std::uint32_t(flag)) != 0;
}

void add_distinct(std::vector<Vec3d>& normals, Vec3d n) {
  const bool known =
      std::any_of(normals.begin(), normals.end(), [&](Vec3d m) { return dot(m, n) > 1 - 1e-10; });
  if (!known) normals.push_back(n);
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace

OracleSurface::OracleSurface(const ImageView& image)
    : open(has(image, image::HeaderFlag::open)),
      solid_depth_m(0.1 * image.header->radius_m),
      tree(std::make_unique<Tree>()) {
  read_triangles(image);
  link_edges(image);
  gather_normals(image);
  build_tree();
}

void OracleSurface::read_triangles(const ImageView& image) {
  const double* c = image.header->centre_m;
  const double radius_m = image.header->radius_m;
  for (const image::SurfaceVertex& v : image.surface_vertices) {
    vertices.push_back({Vec3d{c[0], c[1], c[2]} + radius_m * vec3d(v.position), {}, {}, {}});
  }
  constexpr double kLeastHeight = 1e-6;  // in radii; less is rounding
  const bool crossing = has(image, image::HeaderFlag::self_crossing);
  for (const image::TriangleVertices& t : image.triangle_vertices) {
    Triangle& out = triangles.emplace_back();
    out.edge = {kNone, kNone, kNone};
    out.crosses = crossing;
    Vec3d p[3];
    for (std::size_t i = 0; i < 3; ++i) {
      out.corner[i] = t.corner[i];
      p[i] = vertices[t.corner[i]].position;
      out.crosses = out.crosses && has_no_inside(image, t.corner[i]);
    }
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, norm(p[(i + 1) % 3] - p[i]));
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    if (norm(normal) > kLeastHeight * radius_m * longest) out.normal = unit(normal);
  }
}

/// By the neighbours of their triangles.
void OracleSurface::link_edges(const ImageView& image) {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (triangles[t].edge[i] != kNone) continue;
      const auto number = std::uint32_t(edges.size());
      triangles[t].edge[i] = number;
      Edge edge{triangles[t].corner[i], triangles[t].corner[(i + 1) % 3], {t}, false, false};
      const std::uint32_t beyond = image.region_triangles[t].neighbours[i];
      if (beyond != kNone) {
        edge.faces.push_back(beyond);
        const auto& other = triangles[beyond].corner;
        for (std::uint32_t k = 0; k < 3; ++k) {
          if (other[k] != edge.to || other[(k + 1) % 3] != edge.from) continue;
          triangles[beyond].edge[k] = number;
          bend(edge, other[(k + 2) % 3]);
        }
      }
      edges.push_back(edge);
    }
  }
}

/// @param opposite  the corner of the second face that is not on the edge
void OracleSurface::bend(Edge& edge, std::uint32_t opposite) const {
  const Vec3d n = triangles[edge.faces[0]].normal, m = triangles[edge.faces[1]].normal;
  if (norm(n) == 0 || norm(m) == 0 || angle_between(n, m) <= 1e-4) return;
  const double height = dot(n, vertices[opposite].position - vertices[edge.from].position);
  edge.convex = height < 0;
  edge.concave = height > 0;
}

void OracleSurface::gather_normals(const ImageView& image) {
  for (const Triangle& t : triangles) {
    if (norm(t.normal) == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t after = (i + 1) % 3, before = (i + 2) % 3;
      Vertex& v = vertices[t.corner[i]];
      add_distinct(v.normals, t.normal);
      if (edges[t.edge[i]].concave || edges[t.edge[before]].concave) {
        add_distinct(v.concave_normals, t.normal);
      }
      if (has_no_inside(image, t.corner[i])) continue;
      v.pseudonormal += angle_between(vertices[t.corner[after]].position - v.position,
                                      vertices[t.corner[before]].position - v.position) *
                        t.normal;
    }
  }
}

void OracleSurface::build_tree() {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (norm(triangles[t].normal) == 0) continue;
    const auto corner = [&](std::size_t i) {
      return to_cgal(vertices[triangles[t].corner[i]].position);
    };
    tree->boxes.insert(Tree::Primitive{t, Kernel::Triangle_3(corner(0), corner(1), corner(2))});
  }
  tree->boxes.build();
  tree->boxes.accelerate_distance_queries();
}

OracleSurface::~OracleSurface() = default;

namespace {

/// phi, or something between `enough` and phi.
double signed_distance(const Surface& q, Vec3d x, double enough = kInfinity) {
  const CGAL::Bbox_3 box = q.tree->boxes.bbox();
  const auto outside = [](double v, double least, double most) {
    return std::max({0.0, least - v, v - most});
  };
  const Vec3d beyond{outside(x.x, box.xmin(), box.xmax()), outside(x.y, box.ymin(), box.ymax()),
                     outside(x.z, box.zmin(), box.zmax())};
  if (norm(beyond) > enough) return norm(beyond);
  const auto found = q.tree->boxes.closest_point_and_primitive(to_cgal(x));
  Foot nearest = closest(q, found.second, x);
  for (const std::uint32_t t : q.tree->in_box(x, nearest.distance * (1 + 1e-9))) {
    const Foot foot = closest(q, t, x);
    if (foot.distance < nearest.distance) nearest = foot;
  }
  const bool behind = dot(x - nearest.point, pseudonormal_at(q, nearest)) < 0;
  if (!behind || (q.open && nearest.distance >= q.solid_depth_m)) return nearest.distance;
  return -nearest.distance;
}

double solidity(const Surface& q, double depth) {
  return q.open ? clamp01(2 - 2 * depth / q.solid_depth_m) : 1;
}

/// P seen from Q.
struct Side {
  const Surface& p;
  const Surface& q;
  Mat3d rotation{};
  Vec3d translation{};
  [[nodiscard]] Vec3d to_q(Vec3d x) const { return rotation * x + translation; }
  [[nodiscard]] Vec3d to_p(Vec3d x) const { return transpose(rotation) * (x - translation); }
  [[nodiscard]] Vec3d turned_to_q(Vec3d n) const { return rotation * n; }
  [[nodiscard]] Vec3d turned_to_p(Vec3d n) const { return transpose(rotation) * n; }
};

Side side_of(const Surface& p, const Pose& pose_p, const Surface& q, const Pose& pose_q) {
  const Mat3d r_p = rotation(pose_p.orientation);
  const Mat3d back = transpose(rotation(pose_q.orientation));
  const Mat3d columns{back * Vec3d{r_p.row0.x, r_p.row1.x, r_p.row2.x},
                      back * Vec3d{r_p.row0.y, r_p.row1.y, r_p.row2.y},
                      back * Vec3d{r_p.row0.z, r_p.row1.z, r_p.row2.z}};
  return {p, q, transpose(columns), back * (pose_p.position_m - pose_q.position_m)};
}

/// In Q's axes; the normal pushes P.
struct Found {
  Vec3d normal{};
  double distance = 0;
  double weight = 0;
  Vec3d place{};
};

/// Sec. 2.1.
std::vector<Found> contacts_of_vertex(const Side& side, const Surface::Vertex& vertex,
                                      double delta) {
  const Surface& q = side.q;
  const Vec3d x = side.to_q(vertex.position);
  const double reach = 1.25 * delta;
  std::vector<Found> found;
  const double phi = signed_distance(q, x, reach);
  if (phi > reach) return found;
  const bool inside = phi < 0;
  const double h = std::max(0.0, -phi);
  const double solid = solidity(q, h);
  const auto add = [&](Vec3d n, double d, double w) {
    if (d > reach) return;
    w *= within_reach(d, delta) * f(nearest(side.turned_to_p(-n), vertex.normals).cosine);
    if (!(w > 0)) return;
    for (Found& c : found) {
      if (std::abs(c.distance - d) < 1e-9 * delta && dot(c.normal, n) > 1 - 1e-12) {
        c.weight = std::max(c.weight, w);
        return;
      }
    }
    found.push_back({n, d, w, x - 0.5 * d * n});
  };
  struct Way {
    Vec3d normal;
    double strength;
  };
  std::vector<Way> ways;
  double strongest = 0;         // W
  double shortest = kInfinity;  // min t / (b q)
  const double radius = std::max(reach * std::numbers::sqrt2, 3 * h);
  for (const std::uint32_t t : q.tree->in_box(x, radius)) {
    const Foot foot = closest(q, t, x);
    if (foot.distance > radius) continue;
    const Vec3d a = x - foot.point;
    const bool touching = foot.distance < 1e-9 * delta;
    const bool behind = touching ? inside : dot(a, pseudonormal_at(q, foot)) < 0;
    const Vec3d u = touching ? q.triangles[t].normal : (behind ? -1.0 : 1.0) * unit(a);
    const Nearest towards = touching ? Nearest{u, 1} : nearest(u, normals_at(q, foot));
    const Vec3d n = towards.normal;
    const double b = f(towards.cosine);
    if (!behind) add(n, dot(n, a), b);
    if (behind && inside && b > 0) {
      const double length = std::max(0.0, -dot(n, a));
      const double willing = clamp01(1 + 2 * nearest(side.turned_to_p(-n), vertex.normals).cosine);
      const double s = directness(h, foot.distance) * b * willing;
      if (b * willing > 0) shortest = std::min(shortest, length / (b * willing));
      if (s > 0) {
        ways.push_back({n, s});
        strongest = std::max(strongest, s);
      }
    }
    if (!inside || (foot.corner < 0 && foot.side < 0)) continue;
    const auto beside = [&](Vec3d m) {
      const double d = dot(m, a);
      const double l = norm(a - d * m);
      const double z = std::max(delta, std::abs(d));
      add(m, d, solid * clamp01(2 * (1 - l / z)) * (d < 0 ? directness(h, foot.distance) : 1));
    };
    if (foot.corner >= 0) {
      const auto number = q.triangles[t].corner[std::size_t(foot.corner)];
      for (const Vec3d& m : q.vertices[number].concave_normals) beside(m);
    } else if (q.edges[q.triangles[t].edge[std::size_t(foot.side)]].concave) {
      for (const std::uint32_t face : q.edges[q.triangles[t].edge[std::size_t(foot.side)]].faces) {
        beside(q.triangles[face].normal);
      }
    }
  }
  Vec3d v{};
  for (const Way& way : ways) {
    double akin = 0;
    for (const Way& other : ways) {
      const double c = dot(way.normal, other.normal);
      akin += other.strength * c * c * (1 + c) / 2;
    }
    v += (way.strength * way.strength / akin) * way.normal;
  }
  if (norm(v) > 0) {
    add(unit(v), -shortest, solid * strongest * clamp01(2 * norm(v) / strongest));
  }
  return found;
}

std::vector<Vec3d> normals_of(const Surface& s, const Surface::Edge& e) {
  return {s.triangles[e.faces[0]].normal, s.triangles[e.faces[1]].normal};
}

/// What Sec. 2.2 asks of one of the two points of edges that cross in overlap, x in Q.
/// @param faces  cosine of ang(-way, N of the point's own edge)
template <class Faces>
double share_inside(const Surface& q, Vec3d x, double overlap, Faces faces) {
  const double h = -signed_distance(q, x);
  if (!(h > 0)) return 0;
  double shortest = kInfinity;
  for (const std::uint32_t t : q.tree->in_box(x, overlap)) {
    const Foot foot = closest(q, t, x);
    const Vec3d u = unit(foot.point - x);
    if (!(foot.distance > 0) || dot(u, pseudonormal_at(q, foot)) <= 0) continue;
    const double both = f(nearest(u, normals_at(q, foot)).cosine) * f(faces(u));
    if (both > 0) shortest = std::min(shortest, foot.distance / both);
  }
  const double direct = shortest < kInfinity ? directness(shortest, overlap) : 1;
  return clamp01((4 - overlap / h) / 2) * direct * solidity(q, h);
}

/// Sec. 2.2, of one pair of convex edges. Everything in Q's axes.
std::optional<Found> contact_of_edges(const Side& side, const Surface::Edge& p,
                                      const Surface::Edge& q, double delta) {
  const Vec3d p0 = side.to_q(side.p.vertices[p.from].position);
  const Vec3d along_p = side.to_q(side.p.vertices[p.to].position) - p0;
  const Vec3d q0 = side.q.vertices[q.from].position;
  const Vec3d along_q = side.q.vertices[q.to].position - q0;
  const double length_p = norm(along_p), length_q = norm(along_q);
  const Vec3d across = cross(along_p, along_q);
  const double sine = norm(across) / (length_p * length_q);
  if (!(sine > 0.001)) return {};
  const double s = dot(cross(q0 - p0, along_q), across) / squared_norm(across);
  const double t = dot(cross(q0 - p0, along_p), across) / squared_norm(across);
  if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return {};
  const Vec3d x = p0 + s * along_p, y = q0 + t * along_q;
  std::vector<Vec3d> arc_p = normals_of(side.p, p);
  for (Vec3d& n : arc_p) n = side.turned_to_q(n);
  const std::vector<Vec3d> arc_q = normals_of(side.q, q);
  Vec3d n = unit(across);
  if (dot(n, arc_q[0] + arc_q[1]) < 0) n = -n;
  if (dot(n, arc_p[0] + arc_p[1]) >= 0) return {};
  const double d = dot(n, x - y);
  if (d > 1.25 * delta) return {};
  double w = f(nearest(-n, arc_p).cosine) * f(nearest(n, arc_q).cosine) * within_reach(d, delta) *
             clamp01((sine - 0.001) / 0.05);
  if (w > 0 && d < -1e-9 * delta) {
    const double end_p = std::min(s, 1 - s) * length_p, end_q = std::min(t, 1 - t) * length_q;
    w *= clamp01(std::min(end_p, end_q) / -d);
    if (w > 0) {
      w *= share_inside(side.q, x, -d, [&](Vec3d way) { return nearest(-way, arc_p).cosine; });
    }
    if (w > 0) {
      w *= share_inside(side.p, side.to_p(y), -d,
                        [&](Vec3d way) { return nearest(-side.turned_to_q(way), arc_q).cosine; });
    }
  }
  if (!(w > 0)) return {};
  return Found{n, d, w, x - 0.5 * d * n};
}

/// Sec. 2.2.
/// @param distances  of the vertices of P from Q, from below
std::vector<Found> contacts_of_edges(const Side& side, const std::vector<double>& distances,
                                     double delta) {
  std::vector<Found> found;
  for (const Surface::Edge& p : side.p.edges) {
    if (!p.convex) continue;
    const Vec3d from = side.to_q(side.p.vertices[p.from].position);
    const Vec3d to = side.to_q(side.p.vertices[p.to].position);
    // An overlap is at most four depths long; depths change no faster than points move.
    const double deepest = side.q.open
                               ? side.q.solid_depth_m
                               : 0.5 * (norm(to - from) - distances[p.from] - distances[p.to]);
    const double reach = std::max(1.25 * delta, 4 * deepest);
    const Vec3d r{reach, reach, reach};
    const Vec3d least{std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)};
    const Vec3d most{std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)};
    std::vector<std::uint32_t> near;
    for (const std::uint32_t t : side.q.tree->between(least - r, most + r)) {
      for (const std::uint32_t e : side.q.triangles[t].edge) near.push_back(e);
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t e : near) {
      if (!side.q.edges[e].convex) continue;
      if (const auto contact = contact_of_edges(side, p, side.q.edges[e], delta)) {
        found.push_back(*contact);
      }
    }
  }
  return found;
}

/// In world axes; the normal pushes a.
struct Contact {
  Vec3d normal{};
  double distance = 0;  ///< d
  double weight = 0;    ///< w
  double strength = 0;  ///< g
  Vec3d place{};
};

/// Sec. 5, without clusters.
Vec3d torque_of(const std::vector<Contact>& contacts, const LeastPush& push, Vec3d origin_m,
                double stiffness) {
  Vec3d torque{};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!(push.multipliers[i] > 0)) continue;
    Vec3d sum{};
    double all = 0;
    for (const Contact& c : contacts) {
      const double cosine = dot(contacts[i].normal, c.normal);
      const double above = c.strength - 0.5 * std::max(0.0, push.along(c.normal));
      if (cosine <= 0 || c.strength <= 0 || above <= 0) continue;
      const double mass = above * above * 0.5 * cosine * cosine * (1 + cosine);
      sum += mass * c.place;
      all += mass;
    }
    const Vec3d place = all > 0 ? (1 / all) * sum : contacts[i].place;
    torque += cross(place - origin_m, 2 * stiffness * push.multipliers[i] * contacts[i].normal);
  }
  return torque;
}

}  // namespace

Wrench contact_oracle(const OracleSurface& a, const Pose& pose_a, const OracleSurface& b,
                      const Pose& pose_b, double delta_m, double stiffness_N_per_m) {
  std::vector<Contact> contacts;
  const auto keep = [&](const Found& c, const Pose& pose_q, double sign) {
    const Mat3d r = rotation(pose_q.orientation);
    contacts.push_back(
        {sign * (r * c.normal), c.distance, c.weight, 0, pose_q.position_m + r * c.place});
  };
  const auto see = [&](const Side& side, const Pose& pose_q, double sign) {
    std::vector<double> distances;  // from below
    for (const auto& v : side.p.vertices) {
      distances.push_back(signed_distance(side.q, side.to_q(v.position), delta_m));
      for (const Found& c : contacts_of_vertex(side, v, delta_m)) keep(c, pose_q, sign);
    }
    for (const Found& c : contacts_of_edges(side, distances, delta_m)) keep(c, pose_q, sign);
  };
  see(side_of(a, pose_a, b, pose_b), pose_b, 1);
  see(side_of(b, pose_b, a, pose_a), pose_a, -1);
  double most = 0;  // G
  for (const Contact& c : contacts) {
    most = std::max(most, c.weight * (delta_m - c.distance));
  }
  std::vector<Constraint> constraints;
  for (Contact& c : contacts) {
    c.strength = c.weight * (delta_m - c.distance) - (1 - c.weight) * most / 2;
    constraints.push_back({c.normal, c.strength});
  }
  const LeastPush push = least_push(constraints);
  return {2 * stiffness_N_per_m * push.vector(),
          torque_of(contacts, push, pose_a.position_m, stiffness_N_per_m)};
}

}  // namespace palpate::test
