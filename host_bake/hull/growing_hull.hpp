// SPDX-License-Identifier: GPL-3.0-or-later
// A convex hull that grows vertex by vertex, by exact predicates, and can be taken back.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host_bake/hull/facets.hpp"

namespace palpate::bake {

/// The boundary of the hull as a closed triangulation with neighbours. It starts as a flat polygon
/// (two sides of triangles) and becomes solid with the first vertex off that plane.
///
/// A facet triangle may be real: it lies in a plane that a face of the surface spans. Real planes
/// must go on supporting the hull; a vertex strictly above one is refused. Triangles in one plane
/// are all real or all not.
///
/// Every decision is the exact sign of a determinant (beneath-beyond; Edelsbrunner 1987), so the
/// triangulation is closed, oriented and weakly convex at all times. Vertices on the hull but not
/// strictly outside it are left out, and vertices may cease to be extreme but stay;
/// canonical_hull() drops those.
///
/// Cost of insert(): the facets it sees, the star of the vertex near which it starts to look, and
/// where nothing is seen from there, a walk to the facet below the vertex.
class GrowingHull {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Facet {
    Triangle vertices{};
    std::array<std::uint32_t, 3> neighbours{};  ///< across the edge from corner i to corner i + 1
    std::uint32_t visit = 0;
    bool alive = false;
    bool real = false;
  };
  using Mark = std::size_t;

  /// The points must outlive the hull and keep their positions while it is in use.
  explicit GrowingHull(std::span<const PointF> points);

  /// Begins again from a strictly convex polygon of at least three points in one plane,
  /// counter-clockwise seen from above. With `real` its upper side is real.
  void start(std::span<const std::uint32_t> ring, bool real);

  /// Adds vertex v. False, and nothing changed, where v lies strictly above a real plane. A vertex
  /// that is in the hull or on it changes nothing; so does one in the plane of a flat hull: add one
  /// off the plane first. near: a vertex where to look first; any value is correct.
  [[nodiscard]] bool insert(std::uint32_t v, std::uint32_t near);

  /// No vertex of the hull lies strictly above the plane of a, b, c.
  /// near: a vertex in that plane; decided in its star where the hull has it, else over all facets.
  [[nodiscard]] bool supported_by(const Triangle& plane, std::uint32_t near) const;

  /// Makes the facet in the supporting plane of a, b, c real. The hull is solid. near as above.
  void mark_real(const Triangle& plane, std::uint32_t near);

  /// Taking back: rollback(m) returns to the state when mark() gave m; commit() makes all so far
  /// final.
  [[nodiscard]] Mark mark() const { return steps_.size(); }
  void rollback(Mark mark);
  void commit();

  /// Slots of the facets that vertices added since the last commit() have replaced.
  [[nodiscard]] std::span<const std::uint32_t> replaced() const { return removed_; }
  /// A vertex was added since the last commit().
  [[nodiscard]] bool grown() const { return !added_.empty(); }
  [[nodiscard]] bool flat() const { return flat_; }
  /// A corner of the triangulation.
  [[nodiscard]] bool has(std::uint32_t v) const { return facet_of_[v] != kNone; }
  /// Living facets and unused slots.
  [[nodiscard]] std::span<const Facet> slots() const { return facets_; }
  [[nodiscard]] std::vector<Triangle> triangles() const;
  [[nodiscard]] std::span<const PointF> points() const { return points_; }

 private:
  struct Horizon {
    std::uint32_t outside, slot;  // the facet that stays, and its edge
    std::uint32_t inside;         // the facet that goes
    std::uint32_t from, to;       // the edge as the facet that goes has it
    bool real;                    // the new facet lies in the real plane of the outside one
  };
  struct Step {
    std::size_t removed, horizon, added, marked;  // where its entries begin in the logs below
    std::uint32_t vertex;
    bool was_flat;
  };

  [[nodiscard]] int side(const Facet& facet, std::uint32_t v) const;
  [[nodiscard]] int side(const Triangle& plane, std::uint32_t v) const;
  template <class Visit>
  void around(std::uint32_t v, Visit visit) const;
  [[nodiscard]] std::uint32_t find_visible(std::uint32_t v, std::uint32_t near);
  [[nodiscard]] std::uint32_t find_below(std::uint32_t v, std::uint32_t from) const;
  [[nodiscard]] bool find_inner();
  [[nodiscard]] bool collect_visible(std::uint32_t v, std::uint32_t first);
  void open_step(std::uint32_t vertex);
  void drop_step();
  void raise_cone(std::uint32_t v, const Step& step);
  std::uint32_t new_facet();

  std::span<const PointF> points_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> facet_of_;  // a living facet of each vertex
  std::vector<std::uint32_t>
      cone_at_;                      // scratch: the new facet whose horizon edge starts at a vertex
  std::vector<std::uint32_t> used_;  // vertices whose facet_of_ has been set since start()
  bool flat_ = true;
  std::uint32_t visit_ = 0;
  PointF inner_{};  // strictly inside, where has_inner_
  bool has_inner_ = false;
  std::size_t inner_since_ = 0;  // steps that had been taken when it was found

  std::vector<Step> steps_;
  std::vector<std::uint32_t> removed_, added_, marked_;
  std::vector<Horizon> horizon_;
};

}  // namespace palpate::bake
