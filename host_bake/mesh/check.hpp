// SPDX-License-Identifier: GPL-3.0-or-later
// Is a mesh what the baker needs: an oriented 2-manifold with or without boundary, free of self-intersections?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

enum class Severity {
  note,       ///< said, baked as it is: self-crossing faces, open boundaries, tiny components
  repairable, ///< refused as it is; repair() mends it
  error,      ///< refused, and no safe repair is known
};

/// One rule of the check that a mesh breaks.
struct Finding {
  std::string rule;            ///< "non-manifold edge", "degenerate face", ...
  Severity severity = Severity::note;
  std::size_t count = 0;       ///< places
  std::vector<Point> first;    ///< the first few of them, metres
  std::string mend;            ///< what to do about it
};

struct CheckReport {
  std::size_t vertices = 0, faces = 0, components = 0, closed_components = 0, boundary_edges = 0;
  std::vector<std::size_t> crossing_faces;  ///< faces that properly cross another one, ascending
  std::size_t crossings = 0;                ///< pairs of them
  std::vector<std::uint32_t> face_component;  ///< component of each face
  std::vector<char> component_closed;         ///< no boundary edge
  std::vector<Finding> findings;
  [[nodiscard]] bool bakeable() const;      ///< no finding is repairable or error
  [[nodiscard]] bool clean() const;         ///< no findings at all but open boundaries
};

/// O(n log n). Never throws for a mesh that read_mesh() gave.
CheckReport check(const Mesh& mesh);

struct RepairReport {
  std::vector<std::string> done;  ///< one line an action: "3 duplicate faces removed"
};

/// Mends what a safe repair can: duplicate and degenerate faces, inconsistent and inward orientation, non-manifold vertices
/// (duplicated), isolated vertices. Never moves a vertex, never closes a hole. Deterministic.
RepairReport repair(Mesh& mesh);

/// Throws InputRefused with the first finding that is not a note (rule, count, first coordinates). With `strict` also for
/// self-crossing faces. `file` is named in the message.
void require_bakeable(const CheckReport& report, const std::string& file, bool strict);

}  // namespace palpate::bake
