// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh in, memory image out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/mesh.hpp"
#include "host_bake/metrics/support_area.hpp"
#include "host_bake/simplify/simplify.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::bake {

/// Which query engines an image serves. Convex pieces of the original surface are always baked: the
/// region engine measures overlap by them.
enum class ForEngine {
  levels,   ///< pieces of the original surface, simplified levels, free levels
  regions,  ///< no simplified levels; a wide tree over the triangles
  both,
};

struct BakeOptions {
  ForEngine engine = ForEngine::levels;
  double delta_rel =
      0.01;  ///< contact tolerance that the metrics are made for, relative to the radius
  SupportReading support = SupportReading::one_ring;
  /// The surface may first be made coarser, by at most this share of the radius (reduce.hpp), which
  /// the image records; 0: it is baked as it is.
  double max_deviation_rel = 0;
  /// Stop rules of simplification, recorded in the image. The first that applies ends it.
  SimplifyOptions stop;
  double stop_deviation_rel = 0;  ///< no level whose s passes this; 0: no such rule

  // Only what a scene requires (prune.hpp); 0: everything. For the levels engine only.
  double s0_min = 0;          ///< the image has to serve every threshold from this up ...
  double partner_area = 0;    ///< ... against partners with at least these support areas
  std::size_t max_bytes = 0;  ///< the finest image that is no larger

  unsigned threads = 0;   ///< 0: all
  bool repaired = false;  ///< recorded in the image
  std::array<std::uint8_t, 32> source_sha256{};
};

struct BakeReport {
  std::map<std::string, double> seconds;          ///< by stage
  std::map<std::string, std::uint64_t> rejected;  ///< attempts refused, by reason
  std::size_t peak_bytes = 0;                     ///< resident set, high-water mark of the process
  unsigned threads = 0;
  std::size_t mesh_triangles = 0;   ///< before the surface was made coarser
  std::size_t slivers_removed = 0;  ///< mesh/slivers.hpp
};

/// Bakes a mesh that require_bakeable() let pass. The bytes depend on mesh, check and options only,
/// not on threads or host. The result has been passed through palpate::validate(). Throws
/// InputRefused where a limit of the format is met, where no image serves s0_min in max_bytes, or
/// where either is asked of an image for regions.
std::vector<std::byte> bake(const Mesh& mesh, const CheckReport& check, const BakeOptions& options,
                            const Progress& progress, BakeReport& out_report);

/// One invariant of docs/FORMAT.md and whether it holds for an image.
struct Proof {
  std::string invariant;
  bool holds = true;
  std::string found;  ///< the measured figure, or the first place where it fails
};

/// Proves the invariants of a validated image one by one: convexity constraints at every level,
/// enclosure (parent tolerance nesting), spheres, adjacency against true hulls, every source
/// triangle in exactly one leaf, levels, s, h, D.
std::vector<Proof> verify(const ImageView& image);

}  // namespace palpate::bake
