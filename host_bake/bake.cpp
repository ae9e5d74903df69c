// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/bake.hpp"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/hierarchy/hierarchy.hpp"
#include "host_bake/hierarchy/merge.hpp"
#include "host_bake/metrics/metrics.hpp"
#include "host_bake/metrics/support_area.hpp"
#include "host_bake/pack/aligned.hpp"
#include "host_bake/pack/pack.hpp"

namespace palpate::bake {
namespace {

// Runs a stage and adds its seconds to the report.
template <class Stage>
auto timed(BakeReport& report, const std::string& name, Stage stage) {
  const auto start = std::chrono::steady_clock::now();
  auto result = stage();
  report.seconds[name] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::size_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void require_in_format(const NormalMesh& mesh, const BakeOptions& options) {
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

image::Header facts_of(const NormalMesh& mesh, const CheckReport& check,
                       const BakeOptions& options) {
  image::Header facts{};
  const auto flag = [](bool set, image::HeaderFlag f) {
    return set ? static_cast<std::uint32_t>(f) : 0u;
  };
  facts.flags = flag(options.repaired, image::HeaderFlag::repaired) |
                flag(check.boundary_edges > 0, image::HeaderFlag::open) |
                flag(check.crossings > 0, image::HeaderFlag::self_crossing);
  std::copy(options.source_sha256.begin(), options.source_sha256.end(), facts.source_sha256);
  std::copy(mesh.centre_m.begin(), mesh.centre_m.end(), facts.centre_m);
  facts.radius_m = mesh.radius_m;
  facts.source_triangles = static_cast<std::uint32_t>(mesh.faces.size());
  facts.source_vertices = static_cast<std::uint32_t>(check.vertices);
  facts.source_components = static_cast<std::uint32_t>(check.components);
  facts.source_boundary_edges = static_cast<std::uint32_t>(check.boundary_edges);
  facts.source_crossings = static_cast<std::uint32_t>(check.crossings);
  facts.delta_rel = static_cast<float>(options.delta_rel);
  return facts;
}

void require_valid(const std::vector<std::byte>& bytes) {
  const AlignedCopy copy(bytes);
  ImageView view;
  const Status status = validate(copy.bytes(), view);
  if (status != Status::ok)
    throw std::logic_error(std::string("the baked image is not valid: ") + describe(status));
}

}  // namespace

std::vector<std::byte> bake(const Mesh& mesh, const CheckReport& check, const BakeOptions& options,
                            const Progress& progress, BakeReport& out_report) {
  const unsigned threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  BakeReport report;
  report.threads = threads;

  const NormalMesh normal = timed(report, "normalise", [&] { return normalise(mesh); });
  require_in_format(normal, options);
  const std::vector<Patch> patches =
      timed(report, "decompose", [&] { return decompose(normal, check, threads, progress); });
  const std::vector<Vec3d> normals = vertex_normals(normal);
  const Hierarchy tree = timed(report, "merge", [&] {
    Hierarchy growing = level_zero(normal, patches, finest_resolution(normal, normals));
    merge_to_root(growing, progress);
    return growing;
  });
  const Metrics metrics = timed(report, "metrics", [&] {
    return measure(tree, support_areas(normal, normals, options.delta_rel), progress);
  });
  std::vector<std::byte> bytes =
      timed(report, "pack", [&] { return pack(tree, metrics, facts_of(normal, check, options)); });
  timed(report, "validate", [&] { return require_valid(bytes), 0; });
  report.peak_bytes = peak_resident_bytes();
  out_report = std::move(report);
  return bytes;
}

}  // namespace palpate::bake
