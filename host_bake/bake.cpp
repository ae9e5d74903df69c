// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/bake.hpp"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/hierarchy/merge.hpp"
#include "host_bake/hierarchy/prune.hpp"
#include "host_bake/mesh/slivers.hpp"
#include "host_bake/metrics/deviation.hpp"
#include "host_bake/metrics/metrics.hpp"
#include "host_bake/metrics/support_area.hpp"
#include "host_bake/pack/aligned.hpp"
#include "host_bake/pack/pack.hpp"
#include "host_bake/regions/region_tree.hpp"
#include "host_bake/simplify/reduce.hpp"

namespace palpate::bake {
namespace {

/// The regions engine asks for pieces of the original surface alone. With sixteen children a piece
/// above them, not two, an image has three fifths of the bytes, and the other engine can still
/// answer exact queries from it.
constexpr int kWideRounds = 4;

// Runs a stage and adds its seconds to the report.
template <class Stage>
auto timed(BakeReport& report, const std::string& name, Stage stage) {
  const auto start = std::chrono::steady_clock::now();
  auto result = stage();
  report.seconds[name] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// Where each stage of a bake begins, as a share of the time that ordinary meshes take for both
/// engines.
struct Stage {
  std::string_view name;
  double from;
};
constexpr std::array<Stage, 8> kStages = {{{"reduce", 0},
                                           {"decompose", 0.03},
                                           {"simplify", 0.07},
                                           {"deviation", 0.30},
                                           {"merge", 0.35},
                                           {"metrics", 0.68},
                                           {"regions", 0.72},
                                           {"pack", 0.82}}};

/// Its stages' progress as one that never goes back. @param progress  must outlive it
Progress of_all_stages(const Progress& progress) {
  if (!progress) return {};
  return [&progress](std::string_view stage, double done) {
    std::size_t i = 0;
    while (i + 1 < kStages.size() && kStages[i].name != stage) ++i;
    const double to = i + 1 < kStages.size() ? kStages[i + 1].from : 1;
    progress(stage, kStages[i].from + done * (to - kStages[i].from));
  };
}

std::size_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void require_in_format(const NormalMesh& mesh, const BakeOptions& options) {
  if (options.engine != ForEngine::levels && (options.s0_min > 0 || options.max_bytes > 0)) {
    throw InputRefused("regions need the original surface, so nothing can be left out",
                       "--s0-min or --max-bytes",
                       "bake with --engine levels, or make the surface coarser (--max-deviation)");
  }
  if (!(options.max_deviation_rel >= 0) || options.max_deviation_rel > kMostDeviation) {
    throw InputRefused("deviation out of range", std::to_string(options.max_deviation_rel),
                       "give a length from 0 to 0.1, relative to the radius");
  }
  if (!(options.delta_rel > 0) || options.delta_rel > static_cast<double>(image::kMaxLength)) {
    throw InputRefused("delta out of range", std::to_string(options.delta_rel),
                       "give a length above 0 and at most 4, relative to the radius");
  }
  if (!(mesh.radius_m >= image::kMinRadius_m && mesh.radius_m <= image::kMaxRadius_m)) {
    throw InputRefused("the object's size is out of range",
                       "radius " + std::to_string(mesh.radius_m) + " m",
                       "scale it to a radius between 1e-12 and 1e12 m (--unit-scale)");
  }
  if (std::any_of(mesh.centre_m.begin(), mesh.centre_m.end(),
                  [](double c) { return std::abs(c) > image::kMaxCentre_m; })) {
    throw InputRefused("the object is too far from its origin", "its centre",
                       "move it to within 1e15 m");
  }
}

image::Header facts_of(const Reduced& surface, const BakeOptions& options) {
  const NormalMesh& mesh = surface.mesh;
  const CheckReport& check = surface.check;
  image::Header facts{};
  const auto flag = [](bool set, image::HeaderFlag f) {
    return set ? static_cast<std::uint32_t>(f) : 0u;
  };
  facts.flags = flag(options.repaired, image::HeaderFlag::repaired) |
                flag(check.boundary_edges > 0, image::HeaderFlag::open) |
                flag(check.crossings > 0, image::HeaderFlag::self_crossing) |
                flag(options.support == SupportReading::grown, image::HeaderFlag::grown_support);
  std::copy(options.source_sha256.begin(), options.source_sha256.end(), facts.source_sha256);
  std::copy(mesh.centre_m.begin(), mesh.centre_m.end(), facts.centre_m);
  facts.radius_m = mesh.radius_m;
  facts.source_triangles = static_cast<std::uint32_t>(mesh.faces.size());
  facts.source_vertices = static_cast<std::uint32_t>(check.vertices);
  facts.source_components = static_cast<std::uint32_t>(check.components);
  facts.source_boundary_edges = static_cast<std::uint32_t>(check.boundary_edges);
  facts.source_crossings = static_cast<std::uint32_t>(check.crossings);
  facts.delta_rel = static_cast<float>(options.delta_rel);
  facts.stop_resolution = static_cast<float>(options.stop.stop_resolution);
  facts.stop_deviation_rel = static_cast<float>(options.stop_deviation_rel);
  facts.stop_pieces = options.stop.stop_pieces;
  facts.source_deviation_rel = surface.deviation;
  return facts;
}

void require_valid(const std::vector<std::byte>& bytes) {
  const AlignedCopy copy(bytes);
  ImageView view;
  const Status status = validate(copy.bytes(), view);
  if (status != Status::ok)
    throw std::logic_error(std::string("the baked image is not valid: ") + describe(status));
}

// Of level 0. An edge's own normals may see it shorter or longer than the vertex does into which it
// is collapsed; r does not rise on the way up.
float resolution_of_original(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                             const std::vector<SimplifiedLevel>& levels) {
  const float own = finest_resolution(mesh, normals);
  return levels.empty() ? own : std::max(own, static_cast<float>(levels.front().resolution));
}

struct Simplified {
  std::vector<SimplifiedLevel> levels;
  std::vector<std::vector<float>> deviations;  // s of each patch of each level
};

bool outside_format(const NormalMesh& mesh) {
  return std::any_of(mesh.points.begin(), mesh.points.end(), [](const auto& p) {
    const auto square = [](float v) { return static_cast<double>(v) * static_cast<double>(v); };
    return std::sqrt(square(p[0]) + square(p[1]) + square(p[2])) >
           static_cast<double>(image::kMaxNorm);
  });
}

// Deviation grows from level to level, so the rule is applied to whole levels.
void measure_deviation(const NormalMesh& mesh, double stop_deviation, const Progress& progress,
                       Simplified& out) {
  if (out.levels.empty()) return;
  const NearestSurface original(mesh);
  for (std::size_t l = 0; l < out.levels.size(); ++l) {
    if (progress)
      progress("deviation", static_cast<double>(l) / static_cast<double>(out.levels.size()));
    std::vector<float> s = surface_deviations(original, out.levels[l].mesh, out.levels[l].patches);
    const bool too_far = outside_format(out.levels[l].mesh) ||
                         (stop_deviation > 0 && std::any_of(s.begin(), s.end(), [&](float v) {
                            return static_cast<double>(v) > stop_deviation;
                          }));
    if (too_far) out.levels.resize(l);
    if (!too_far) out.deviations.push_back(std::move(s));
  }
}

std::vector<std::byte> pack_without(std::uint32_t dropped, Hierarchy tree, Metrics metrics,
                                    const image::Header& facts) {
  drop_levels(tree, metrics, dropped);
  return pack(tree, metrics, facts);
}

// Bytes of the finest image within the options' promise and size.
std::vector<std::byte> pack_required(const Hierarchy& tree, const Metrics& metrics,
                                     const BakeOptions& options, image::Header facts) {
  const auto partner_area = static_cast<float>(options.partner_area);
  const auto next_serves = [&](std::uint32_t dropped) {
    const auto s0 = served_s0(tree, metrics, dropped + 1, partner_area);
    return s0 && static_cast<double>(*s0) <= options.s0_min;
  };
  std::size_t least_bytes = 0;
  std::uint32_t dropped = 0;
  while (options.s0_min > 0 && next_serves(dropped)) ++dropped;
  for (;; ++dropped) {
    const auto s0 = served_s0(tree, metrics, dropped, partner_area);
    const bool serves = s0 && (options.s0_min == 0 || static_cast<double>(*s0) <= options.s0_min);
    if (!serves) {
      throw InputRefused(
          "no image of this object is small enough",
          "at most " + std::to_string(options.max_bytes) + " bytes wanted" +
              (least_bytes == 0 ? std::string()
                                : ", the smallest that serves has " + std::to_string(least_bytes)),
          "allow more bytes, a larger --s0-min, or a larger --partner-area");
    }
    facts.dropped_levels = dropped;
    facts.s0_min = *s0;
    facts.partner_area = dropped > 0 ? partner_area : 0;
    std::vector<std::byte> bytes =
        dropped == 0 ? pack(tree, metrics, facts) : pack_without(dropped, tree, metrics, facts);
    if (options.max_bytes == 0 || bytes.size() <= options.max_bytes) return bytes;
    least_bytes = least_bytes == 0 ? bytes.size() : std::min(least_bytes, bytes.size());
  }
}

}  // namespace

std::vector<std::byte> bake(const Mesh& mesh, const CheckReport& of_mesh,
                            const BakeOptions& options, const Progress& caller,
                            BakeReport& out_report) {
  const Progress progress = of_all_stages(caller);
  const unsigned threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  BakeReport report;
  report.threads = threads;

  NormalMesh whole = timed(report, "normalise", [&] {
    NormalMesh normal = normalise(mesh);
    report.slivers_removed = remove_slivers(normal);
    return normal;
  });
  // A vertex on a neighbour's edge counts as crossing.
  const CheckReport checked =
      report.slivers_removed > 0 ? check(Mesh{mesh.points, whole.faces}) : of_mesh;
  require_in_format(whole, options);
  report.mesh_triangles = whole.faces.size();
  const Reduced surface = timed(report, "reduce", [&] {
    return options.max_deviation_rel > 0
               ? reduce(whole, checked, options.max_deviation_rel, progress)
               : Reduced{.mesh = std::move(whole), .check = checked, .deviation = 0};
  });
  const NormalMesh& normal = surface.mesh;
  const std::vector<Patch> patches = timed(
      report, "decompose", [&] { return decompose(normal, surface.check, threads, progress); });
  const std::vector<Vec3d> normals = vertex_normals(normal);
  SimplifyReport simplification;
  Simplified simplified;
  simplified.levels = timed(report, "simplify", [&] {
    if (options.engine == ForEngine::regions) return std::vector<SimplifiedLevel>{};
    return simplify(normal, surface.check, patches, options.stop, progress, simplification);
  });
  report.rejected = simplification.refused;
  timed(report, "deviation", [&] {
    return measure_deviation(normal, options.stop_deviation_rel, progress, simplified), 0;
  });
  const Hierarchy tree = timed(report, "merge", [&] {
    Hierarchy growing =
        level_zero(normal, patches, resolution_of_original(normal, normals, simplified.levels));
    for (const SimplifiedLevel& level : simplified.levels) add_level(growing, level);
    merge_to_root(growing, progress, options.engine == ForEngine::regions ? kWideRounds : 1);
    return growing;
  });
  const Metrics metrics = timed(report, "metrics", [&] {
    return measure(tree, simplified.levels, simplified.deviations,
                   support_areas(normal, normals, options.delta_rel, options.support), progress);
  });
  if (progress) progress("regions", 0);
  const RegionTree regions = timed(report, "regions", [&] {
    if (options.engine == ForEngine::levels) return RegionTree{};
    return build_regions(normal, region_options(options.delta_rel), surface.check.crossing_faces);
  });
  if (progress) progress("pack", 0);
  std::vector<std::byte> bytes = timed(report, "pack", [&] {
    const image::Header facts = facts_of(surface, options);
    return options.engine == ForEngine::levels ? pack_required(tree, metrics, options, facts)
                                               : pack(tree, metrics, facts, regions);
  });
  timed(report, "validate", [&] { return require_valid(bytes), 0; });
  if (progress) progress("pack", 1);
  report.peak_bytes = peak_resident_bytes();
  out_report = std::move(report);
  return bytes;
}

}  // namespace palpate::bake
