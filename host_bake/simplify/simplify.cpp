// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/hull/predicates.hpp"
#include "host_bake/simplify/constraints.hpp"
#include "host_bake/simplify/edge_queue.hpp"
#include "host_bake/simplify/filtered_collapse.hpp"
#include "host_bake/simplify/level_record.hpp"
#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/quadric.hpp"
#include "host_bake/simplify/surface.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr int kBisections = 3;          // K of Sec. 4.3.2
constexpr double kBoundaryWeight = 10;  // of a boundary edge's plane, against its face's
constexpr double kFewerFaces = 0.9;     // what the last level must have at most, of the one before
constexpr std::uint64_t kAttemptsBetweenReports = 1 << 14;

std::vector<Quadric> quadrics_of(const Surface& surface) {
  std::vector<Quadric> quadrics(surface.points.size());
  for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
    const auto corner = [&](std::uint32_t i) {
      return position(surface.points[surface.faces[f][i]]);
    };
    const Vec3d normal = cross(corner(1) - corner(0), corner(2) - corner(0));
    const double area = norm(normal);
    if (!(area > 0)) continue;
    const Vec3d unit = (1 / area) * normal;
    const Quadric plane = plane_quadric(unit, corner(0), area);
    for (const std::uint32_t v : surface.faces[f]) quadrics[v] += plane;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t h = 3 * f + i;
      if (surface.twin[h] != kNothing) continue;
      const Vec3d edge = corner((i + 1) % 3) - corner(i);
      const double length = norm(edge);
      const Quadric wall = plane_quadric((1 / length) * cross(edge, unit), corner(i),
                                         kBoundaryWeight * length * length);
      quadrics[surface.start(h)] += wall;
      quadrics[surface.end(h)] += wall;
    }
  }
  return quadrics;
}

std::vector<char> frozen_vertices(const NormalMesh& mesh, const CheckReport& report) {
  std::vector<char> frozen(mesh.points.size(), 0);
  for (const std::size_t f : report.crossing_faces)
    for (const std::uint32_t v : mesh.faces[f]) frozen[v] = 1;
  return frozen;
}

class Simplifier {
 public:
  Simplifier(const NormalMesh& mesh, const CheckReport& check, const std::vector<Patch>& initial,
             SimplifyReport& report)
      : surface_(mesh),
        patches_(surface_, initial),
        constraints_(surface_, patches_),
        queue_(surface_),
        quadrics_(quadrics_of(surface_)),
        frozen_(frozen_vertices(mesh, check)),
        record_(mesh, static_cast<std::uint32_t>(initial.size())),
        report_(report) {
    for (std::uint32_t h = 0; h < surface_.twin.size(); ++h)
      if (h < surface_.twin[h]) enqueue(h);
  }

  std::vector<SimplifiedLevel> run(const SimplifyOptions& options, const Progress& progress);

 private:
  void enqueue(std::uint32_t h);
  [[nodiscard]] float key_of(std::uint32_t h);
  [[nodiscard]] Vec3d initial_position(const Ring& ring) const;
  Refusal attempt(std::uint32_t h);
  Refusal try_start(Vec3d initial);
  Refusal settle(const FilterLine& line, Feasible part);
  void collapse(const PointF& position);
  void merge_around();
  void try_merge(std::uint32_t half_edge);
  [[nodiscard]] bool shared_border_convex(std::uint32_t a, std::uint32_t b) const;
  void revalidate();

  Surface surface_;
  PatchLists patches_;
  Constraints constraints_;
  EdgeQueue queue_;
  std::vector<Quadric> quadrics_;
  std::vector<char> frozen_;
  LevelRecord record_;
  SimplifyReport& report_;

  Ring ring_;
  RingShape shape_;
  bool begun_ = false;  // constraints_.begin() has been called for ring_
  std::vector<std::uint32_t> fan_, changed_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> tried_;
};

Vec3d Simplifier::initial_position(const Ring& ring) const {
  Quadric sum = quadrics_[ring.kept];
  sum += quadrics_[ring.removed];
  const Vec3d a = position(surface_.points[ring.kept]);
  const Vec3d b = position(surface_.points[ring.removed]);
  const Vec3d middle = 0.5 * (a + b);
  Vec3d best = middle;
  // Planes that leave a direction nearly free may send the vertex far away.
  if (!least_error_point(sum, middle, best) || !(norm(best - middle) <= 2 * norm(b - a)))
    best = middle;
  return best;
}

float Simplifier::key_of(std::uint32_t h) {
  if (!surface_.find_ring(h, ring_)) {
    const Vec3d edge =
        position(surface_.points[ring_.kept]) - position(surface_.points[ring_.removed]);
    return static_cast<float>(1 / std::max(norm(edge), 1e-7));
  }
  gather(surface_, ring_, shape_);
  const FilterLine line = filter_from(initial_position(ring_), ring_, shape_);
  return static_cast<float>(resolution(surface_, ring_, shape_, line));
}

void Simplifier::enqueue(std::uint32_t h) { queue_.put(h, key_of(h)); }

Refusal Simplifier::settle(const FilterLine& line, Feasible part) {
  const auto rounded = [&](double u) {
    const Vec3f p = vec_cast<float>(line.at(u));
    return PointF{p.x, p.y, p.z};
  };
  if (!begun_) {
    constraints_.begin(ring_);
    begun_ = true;
  }
  PointF position = rounded(part.low);
  Refusal refusal = constraints_.judge(position);
  if (refusal == Refusal::none) {
    if (part.low > 0) ++report_.filtered_in_part;
    collapse(position);
    return Refusal::none;
  }
  if (!(part.high > part.low)) return refusal;
  PointF best = rounded(part.high);
  refusal = constraints_.judge(best);
  if (refusal != Refusal::none) return refusal;
  double bad = part.low, good = part.high;
  bool judged_last = true;  // follow_collapse() needs the accepted position to be judged last
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (bad + good);
    position = rounded(middle);
    judged_last = constraints_.judge(position) == Refusal::none;
    if (judged_last) {
      good = middle;
      best = position;
    } else {
      bad = middle;
    }
  }
  if (!judged_last && constraints_.judge(best) != Refusal::none) return Refusal::local;
  ++report_.filtered_in_part;
  collapse(best);
  return Refusal::none;
}

Refusal Simplifier::try_start(Vec3d initial) {
  const FilterLine line = filter_from(initial, ring_, shape_);
  const Feasible part = feasible_part(ring_, shape_, line, patches_.of_faces());
  return part.empty() ? Refusal::local : settle(line, part);
}

/// v^ from the quadrics, then the ends of the edge: on creases and in planes only they may be
/// feasible.
Refusal Simplifier::attempt(std::uint32_t h) {
  if (!surface_.find_ring(h, ring_)) return Refusal::link;
  if (frozen_[ring_.kept] || frozen_[ring_.removed]) return Refusal::frozen;
  gather(surface_, ring_, shape_);
  begun_ = false;
  Refusal refusal = Refusal::local;
  for (const Vec3d initial : {initial_position(ring_), position(surface_.points[ring_.kept]),
                              position(surface_.points[ring_.removed])}) {
    refusal = try_start(initial);
    if (refusal == Refusal::none) break;
  }
  return refusal;
}

void Simplifier::collapse(const PointF& position) {
  for (const std::uint32_t s : ring_.spokes) queue_.forget(s);
  changed_.clear();
  for (const std::uint32_t s : ring_.spokes) changed_.push_back(s / 3);
  std::array<std::uint32_t, 2> heirs = {kNothing, kNothing};
  const std::array<std::uint32_t, 2> edges = {ring_.edge, ring_.twin};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t e = edges[i];
    if (e == kNothing) continue;
    changed_.push_back(e / 3);
    for (std::uint32_t side = 3 * (e / 3); side < 3 * (e / 3) + 3; ++side) queue_.forget(side);
    const std::uint32_t out = surface_.twin[Surface::previous(e)];
    heirs[i] = (out != kNothing ? out : surface_.twin[Surface::next(e)]) / 3;
  }
  patches_.suspend(surface_, changed_);
  surface_.collapse(ring_, position);
  for (std::size_t i = 0; i < 2; ++i) {
    if (edges[i] == kNothing) continue;
    const std::uint32_t living = patches_.living();
    patches_.drop(edges[i] / 3, heirs[i]);
    report_.vanished_pieces += living - patches_.living();
    record_.face_went(edges[i] / 3, heirs[i]);
    changed_.pop_back();
  }
  patches_.resume(surface_, changed_);
  constraints_.follow_collapse();
  record_.vertex_went(ring_.removed, ring_.kept);
  quadrics_[ring_.kept] += quadrics_[ring_.removed];
}

/// The edges on which two patches meet are convex; decided before anything is copied.
bool Simplifier::shared_border_convex(std::uint32_t a, std::uint32_t b) const {
  if (patches_.size(a) > patches_.size(b)) std::swap(a, b);
  bool convex = true;
  patches_.for_each(a, [&](std::uint32_t f) {
    for (std::uint32_t h = 3 * f; convex && h < 3 * f + 3; ++h) {
      const std::uint32_t t = surface_.twin[h];
      if (t == kNothing || patches_.of(t / 3) != b) continue;
      const auto at = [&](std::uint32_t v) -> const PointF& { return surface_.points[v]; };
      const int s = orient_3d(at(surface_.start(h)), at(surface_.end(h)), at(surface_.apex(h)),
                              at(surface_.apex(t)));
      const auto normal = [&](std::uint32_t e) {
        const Vec3d p = position(at(surface_.start(e)));
        return cross(position(at(surface_.end(e))) - p, position(at(surface_.apex(e))) - p);
      };
      convex = s < 0 || (s == 0 && dot(normal(h), normal(t)) > 0);
    }
  });
  return convex;
}

void Simplifier::try_merge(std::uint32_t half_edge) {
  const std::uint32_t t = surface_.twin[half_edge];
  if (t == kNothing) return;
  const std::pair<std::uint32_t, std::uint32_t> ids =
      std::minmax({patches_.of(half_edge / 3), patches_.of(t / 3)});
  if (ids.first == ids.second) return;
  if (std::find(tried_.begin(), tried_.end(), ids) != tried_.end()) return;
  tried_.push_back(ids);
  for (const std::uint32_t f : {half_edge / 3, t / 3})
    for (const std::uint32_t v : surface_.faces[f])
      if (frozen_[v]) return;
  if (patches_.back_open(ids.first) &&
      patches_.size(ids.first) + patches_.size(ids.second) > image::kMaxOpenPatchTriangles)
    return;
  ++report_.merge_attempts;
  if (!shared_border_convex(ids.first, ids.second)) return;
  if (!constraints_.may_merge(ids.first, ids.second)) return;
  const std::uint32_t kept = patches_.merge(surface_, ids.first, ids.second);
  constraints_.follow_merge(kept, kept == ids.first ? ids.second : ids.first);
  ++report_.merges;
}

void Simplifier::merge_around() {
  tried_.clear();
  for (const std::uint32_t s : ring_.spokes) {
    try_merge(s);
    try_merge(Surface::next(s));
  }
}

/// Edges at the new vertex get new keys; those at its neighbours are outdated.
void Simplifier::revalidate() {
  const std::vector<std::uint32_t> neighbours = ring_.vertices;
  const std::uint32_t centre = ring_.kept;
  for (const std::uint32_t v : neighbours) {
    surface_.find_fan(v, fan_);
    for (const std::uint32_t h : fan_)
      if (surface_.end(h) != centre) queue_.touch(h);
    const std::uint32_t last = Surface::previous(fan_.back());
    if (surface_.twin[last] == kNothing && surface_.start(last) != centre) queue_.touch(last);
  }
  std::vector<std::uint32_t> spokes;
  surface_.find_fan(centre, spokes);
  if (const std::uint32_t last = Surface::previous(spokes.back()); surface_.twin[last] == kNothing)
    spokes.push_back(last);
  for (const std::uint32_t h : spokes) enqueue(h);
}

std::vector<SimplifiedLevel> Simplifier::run(const SimplifyOptions& options,
                                             const Progress& progress) {
  std::vector<SimplifiedLevel> levels;
  std::uint32_t pieces = patches_.living();
  std::uint32_t faces = surface_.living_faces;
  const double all_faces = faces;
  double least = std::numeric_limits<double>::infinity();
  const auto dump = [&] {
    levels.push_back(record_.take(surface_, patches_, least));
    pieces = patches_.living();
    faces = surface_.living_faces;
  };
  while (patches_.living() > options.stop_pieces) {
    const EdgeQueue::Entry edge = queue_.pop();
    if (edge.half_edge == kNothing) break;
    const float key = edge.outdated ? key_of(edge.half_edge) : edge.key;
    if (key < queue_.next_key()) {
      queue_.put(edge.half_edge, key);
      continue;
    }
    if (static_cast<double>(key) < options.stop_resolution) break;
    if (progress && report_.attempts % kAttemptsBetweenReports == 0)
      progress("simplify", 1 - std::log(surface_.living_faces) / std::log(all_faces));
    ++report_.attempts;
    const Refusal refusal = attempt(edge.half_edge);
    if (refusal != Refusal::none) {
      ++report_.refused[name_of(refusal)];
      continue;
    }
    ++report_.collapses;
    least = std::min(least, static_cast<double>(key));
    merge_around();
    revalidate();
    if (2 * patches_.living() <= pieces) dump();
  }
  const bool smaller = patches_.living() < pieces ||
                       static_cast<double>(surface_.living_faces) <= kFewerFaces * faces;
  if (smaller) dump();
  report_.last_resolution = least;
  if (progress) progress("simplify", 1);
  return levels;
}

}  // namespace

std::vector<SimplifiedLevel> simplify(const NormalMesh& mesh, const CheckReport& report,
                                      const std::vector<Patch>& initial,
                                      const SimplifyOptions& options, const Progress& progress,
                                      SimplifyReport& out_report) {
  out_report = {};
  Simplifier simplifier(mesh, report, initial, out_report);
  return simplifier.run(options, progress);
}

}  // namespace palpate::bake
