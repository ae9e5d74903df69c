// SPDX-License-Identifier: GPL-3.0-or-later
// Sensation preserving simplification (Otaduy and Lin 2003, Sec. 4.1 to 4.4 and Appendix A):
// filtered edge collapses in the order of resolution, under the convexity constraints.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/decompose/decompose.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// When to stop: the constraints alone do not (the teeth of a jaw disappear). The first rule that
/// applies counts.
struct SimplifyOptions {
  /// Edges below this resolution (for radius 1) are not collapsed. The coarsest simplified levels
  /// of the paper's five models are at 6.75 to 19.2.
  double stop_resolution = 6;
  std::uint32_t stop_pieces = 0;  ///< stops when there are no more pieces than that
};

/// One level of detail, finer ones first.
struct SimplifiedLevel {
  NormalMesh mesh;             ///< centre and radius as in the original
  std::vector<Patch> patches;  ///< of this mesh
  double resolution = 0;       ///< r: the least resolution of an edge collapsed so far

  // Where the level before went (for the first one: the original mesh and its patches).
  std::vector<std::uint32_t> parent_of_patch;
  /// The vertex into which a vertex has been collapsed. So D of a vertex is the least D of those
  /// that name it.
  std::vector<std::uint32_t> vertex_of_vertex;
  /// The face itself, or the neighbour that took over its area.
  std::vector<std::uint32_t> face_of_face;
};

struct SimplifyReport {
  std::uint64_t attempts = 0, collapses = 0, filtered_in_part = 0;
  std::uint64_t merge_attempts = 0, merges = 0, vanished_pieces = 0;
  std::map<std::string, std::uint64_t> refused;  ///< attempts by the test that refused last
  double last_resolution = 0;                    ///< of the last collapse
};

/// A level each time the number of patches has halved, and one where the process ends, if that has
/// fewer patches or a tenth fewer faces than the last. `initial` is decompose()'s.
///
/// On every level: an oriented 2-manifold of the same Euler number; patches partition its faces and
/// meet the constraints of decompose() exactly as the initial ones do; no new crossings. Edges next
/// to faces that cross in the original are kept as they are. Resolutions do not rise from level to
/// level.
///
/// Deterministic, one thread. Expected O(n log n) time for patches of bounded size; patches that
/// are whole convex components cost no more, others their own size a collapse.
std::vector<SimplifiedLevel> simplify(const NormalMesh& mesh, const CheckReport& report,
                                      const std::vector<Patch>& initial,
                                      const SimplifyOptions& options, const Progress& progress,
                                      SimplifyReport& out_report);

}  // namespace palpate::bake
