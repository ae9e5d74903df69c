// SPDX-License-Identifier: GPL-3.0-or-later
// Is a mesh what the baker needs: an oriented 2-manifold with or without boundary, free of
// self-intersections?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

enum class Severity {
  note,        ///< said, baked as it is: self-crossing faces, open boundaries, tiny components
  repairable,  ///< refused as it is; repair() fixes it
  error,       ///< refused, and no safe repair is known
};

/// One rule of the check that a mesh breaks.
struct Finding {
  std::string rule;  ///< "non-manifold edge", "degenerate face", ...
  Severity severity = Severity::note;
  std::size_t count = 0;     ///< places
  std::vector<Point> first;  ///< the first few of them, metres
  std::string fix;           ///< what to do about it
  double largest_gap_m = 0;  ///< of "corners nearly coincide"
};

struct CheckReport {
  std::size_t vertices = 0, faces = 0, components = 0, closed_components = 0, boundary_edges = 0;
  /// Faces that cross, touch or overlap another one beyond the vertices and edges they share,
  /// ascending; see crossings.hpp.
  std::vector<std::size_t> crossing_faces;
  std::size_t crossings = 0;  ///< pairs of them
  /// Component of each face (faces joined by edges), numbered by first face; 0xffffffff for a face
  /// that repeats a vertex.
  std::vector<std::uint32_t> face_component;
  std::vector<char> component_closed;  ///< no boundary edge
  std::vector<Finding> findings;
  [[nodiscard]] bool bakeable() const;  ///< no finding is repairable or error
  [[nodiscard]] bool clean() const;     ///< no findings at all but open boundaries
};

/// The rules, all by exact predicates but that of cracks:
/// - error: coordinate not finite; index out of range; no triangles; corners nearly coincide (a
///   crack, see cracks.hpp: what is meant as one surface has no inside, and repair() cannot close
///   it); too many overlapping faces (a heap of copies, see crossings.hpp).
/// - repairable: degenerate face (repeats a vertex); duplicate face (same three vertices as an
///   earlier one, whichever way round); non-manifold edge (three faces or more); non-manifold
///   vertex (its faces form more than one fan); inconsistent orientation (an edge whose two faces
///   run the same way); inward orientation (see facing.hpp; asked only when the four before are
///   absent).
/// - note: face without area (collinear, distinct vertices); open boundary; perhaps inward
///   orientation (open surface); tiny component (below 1e-3 of the mesh's diameter); unreferenced
///   vertex; self-intersection.
///
/// A contact from the back of an open surface is felt as one from inside a solid: it is pushed out
/// through the front.
///
/// O(n log n) time and O(n) memory, all cores; the same report on any number of them. Never throws.
CheckReport check(const Mesh& mesh);

/// "3 x non-manifold edge at (x y z) (x y z) ...", metres.
std::string describe(const Finding& finding);

struct RepairReport {
  std::vector<std::string> done;  ///< one line an action: "3 duplicate faces removed"
};

/// Fixes what a safe repair can, in this order: degenerate faces and all but the first of duplicate
/// faces are removed; faces are turned to agree with their neighbours (the majority of each patch
/// stays); each fan of faces round a vertex gets its own copy of it, so that at non-manifold edges
/// and vertices, and along the seam of a one-sided surface, the sheets that touch come apart
/// without a gap; components are turned outward; unreferenced vertices are removed. Never moves a
/// vertex, never adds a face, never closes a hole. What it does to contact: sheets cut apart have
/// open boundaries where they were joined, so a wall in which three sheets meet has no inside any
/// more, while every surface is still felt. Three sheets that also meet elsewhere round both ends
/// of an edge stay joined; check() tells. Deterministic, O(n log n). Precondition: finite
/// coordinates, indices in range, as read_mesh() gives them.
RepairReport repair(Mesh& mesh);

/// Throws InputRefused with the first finding that is not a note (rule, count, first coordinates).
/// With `strict` also for self-crossing faces. `file` is named in the message.
void require_bakeable(const CheckReport& report, const std::string& file, bool strict);

}  // namespace palpate::bake
