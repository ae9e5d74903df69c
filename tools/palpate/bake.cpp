// SPDX-License-Identifier: GPL-3.0-or-later
// palpate bake: mesh to image.
#include "host_bake/bake.hpp"

#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host_bake/pack/aligned.hpp"
#include "host_bake/simplify/reduce.hpp"
#include "tools/palpate/bake_mesh.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/image_json.hpp"
#include "tools/palpate/image_text.hpp"
#include "tools/palpate/mesh_size.hpp"
#include "tools/palpate/output_file.hpp"

namespace palpate::cli {
namespace {

struct Options {
  std::string mesh;
  std::string image;
  std::string report;  ///< empty: none
  std::string engine;  ///< empty: as much as the other options allow
  std::string support = "one-ring";
  std::optional<double> unit_scale;
  BakeRules rules;
  bool quiet = false;
  bake::BakeOptions bake;
};

/// An image with levels left out serves the levels engine only.
bake::ForEngine engine_of(const Options& options) {
  if (options.engine == "levels") return bake::ForEngine::levels;
  const bool reduced = options.bake.s0_min > 0 || options.bake.max_bytes > 0;
  if (!options.engine.empty() && reduced) {
    throw Failure(kUsage, "regions need the original surface, so nothing can be left out",
                  "--engine " + options.engine,
                  "use --engine levels with --s0-min and --max-bytes, or --max-deviation");
  }
  if (options.engine == "regions") return bake::ForEngine::regions;
  return reduced ? bake::ForEngine::levels : bake::ForEngine::both;
}

/// Nobody who gives a unit is asked about it.
void warn_of_unit(const Options& options, const bake::Mesh& mesh) {
  if (options.unit_scale || options.quiet) return;
  const std::string warning = unit_warning(box_of(mesh));
  if (warning.empty()) return;
  std::cerr << "palpate: warning: " << options.mesh << ": " << warning << "\n";
}

Baked bake_file(const Options& options) {
  require_writable(options.image);
  const bake::Progress progress = cli::progress(options.quiet);
  progress("read", 0);
  bake::ReadMesh read = bake::read_mesh(options.mesh, options.unit_scale.value_or(1));
  warn_of_unit(options, read.mesh);
  bake::BakeOptions how = options.bake;
  how.engine = engine_of(options);
  if (options.support == "grown") how.support = bake::SupportReading::grown;
  return bake_mesh(std::move(read), options.mesh, options.rules, how, progress);
}

ImageView view_of(const bake::AlignedCopy& image) {
  ImageView view;
  if (const Status status = validate(image.bytes(), view); status != Status::ok) {
    throw std::logic_error(std::string("the baked image is not valid: ") + describe(status));
  }
  return view;
}

std::string report_text(const Baked& baked, const ImageView& image) {
  nlohmann::json json = image_json(image);
  json["seconds"] = baked.report.seconds;
  json["peak_bytes"] = baked.report.peak_bytes;
  json["threads"] = baked.report.threads;
  json["rejected"] = baked.report.rejected;
  json["welded_corners"] = baked.welded.corners;
  json["welded_largest_gap_m"] = baked.welded.largest_gap_m;
  json["welded_collapsed_triangles"] = baked.welded.collapsed_triangles;
  json["repairs"] = baked.repairs;
  json["mesh_triangles"] = baked.report.mesh_triangles;
  json["slivers_removed"] = baked.report.slivers_removed;
  return json.dump(2) + "\n";
}

void print(const Options& options, const Baked& baked, const ImageView& image) {
  if (baked.welded.corners > 0) std::cout << "welded: " << describe(baked.welded) << "\n";
  for (const std::string& line : baked.repairs) std::cout << "repair: " << line << "\n";
  const std::size_t before = baked.report.mesh_triangles;
  if (before != image.header->source_triangles) {
    std::cout << "detail: " << before << " triangles to " << image.header->source_triangles
              << ", within " << static_cast<double>(image.header->source_deviation_rel)
              << " of the radius\n";
  }
  const double seconds =
      std::accumulate(baked.report.seconds.begin(), baked.report.seconds.end(), 0.0,
                      [](double sum, const auto& stage) { return sum + stage.second; });
  char figures[160];
  std::snprintf(figures, sizeof figures,
                "%u triangles, %u pieces, %zu levels, %llu bytes, %.1f s, peak memory %.0f MB",
                image.header->source_triangles, image.header->leaf_pieces, image.levels.size(),
                static_cast<unsigned long long>(image.header->total_bytes), seconds,
                static_cast<double>(baked.report.peak_bytes) / 1e6);
  std::cout << options.image << ": " << figures << "\n" << table_2_text(image);
}

void bake(const Options& options) {
  const Baked baked = bake_file(options);
  const bake::AlignedCopy image(baked.bytes);
  const ImageView view = view_of(image);
  const std::string text = report_text(baked, view);
  OutputFile image_file(options.image, image.bytes());
  std::optional<OutputFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report, std::as_bytes(std::span(text)));
  image_file.commit();
  if (report_file) report_file->commit();
  if (!options.quiet) print(options, baked, view);
}

void add_stop_rules(CLI::App& command, bake::BakeOptions& options) {
  command
      .add_option("--stop-resolution", options.stop.stop_resolution,
                  "Simplify no further than this resolution r, for radius 1")
      ->check(number_between(0, 1e9))
      ->capture_default_str();
  command
      .add_option("--stop-deviation", options.stop_deviation_rel,
                  "Keep no level that deviates by more than this share of the radius; 0: any")
      ->check(number_between(0, 4))
      ->capture_default_str();
  command
      .add_option("--stop-pieces", options.stop.stop_pieces,
                  "Simplify to no fewer pieces than this")
      ->capture_default_str();
}

void add_requirements(CLI::App& command, bake::BakeOptions& options) {
  command
      .add_option("--max-deviation", options.max_deviation_rel,
                  "Leave out detail first: bake a coarser surface, no farther than this share of "
                  "the radius from the mesh; 0: the mesh itself")
      ->check(number_between(0, bake::kMostDeviation))
      ->capture_default_str();
  command
      .add_option("--s0-min", options.s0_min,
                  "Leave out the levels that no threshold s0 from this up can reach")
      ->check(number_between(1e-30, 1e6));
  command
      .add_option("--max-bytes", options.max_bytes,
                  "Leave out the finest levels until the image is no larger than this")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--partner-area", options.partner_area,
                  "Least support area of the objects it will touch, relative to this one's radius "
                  "squared: with --s0-min or --max-bytes")
      ->check(number_between(0, 1e9));
}

}  // namespace

void add_bake(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bake", "Make an image from a mesh");
  command->add_option("MESH", options->mesh, "OBJ, PLY, STL or OFF file")->required();
  command->add_option("-o,--output", options->image, "Image file")
      ->required()
      ->check(named_as(".palp"));
  command
      ->add_option("--delta", options->bake.delta_rel,
                   "Contact tolerance that the support areas are made for, relative to the radius")
      ->check(number_between(1e-9, 4))
      ->capture_default_str();
  command
      ->add_option("--unit-scale", options->unit_scale,
                   "Metres of one unit of the file; default: 1")
      ->check(number_between(1e-15, 1e15));
  command->add_flag("--repair", options->rules.repair, "Fix what a safe repair can, see check");
  command->add_flag("--strict", options->rules.strict,
                    "Refuse a mesh whose faces cross one another");
  command
      ->add_option("--support-area", options->support,
                   "Surface that supports a contact (D of eq. 7): the vertex's own faces, or those "
                   "grown from them within the contact tolerance")
      ->check(CLI::IsMember({"one-ring", "grown"}))
      ->capture_default_str();
  add_stop_rules(*command, options->bake);
  add_requirements(*command, options->bake);
  command
      ->add_option("--engine", options->engine,
                   "Query engine that the image is for; default: both, or levels where --s0-min or "
                   "--max-bytes leave something out")
      ->check(CLI::IsMember({"levels", "regions", "both"}));
  command->add_option("--threads", options->bake.threads, "Threads to use, 0: all cores")
      ->check(CLI::Range(0u, kMaxThreads))
      ->capture_default_str();
  command->add_option("--report", options->report, "Write figures of image and bake as JSON")
      ->check(named_as(".json"));
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options] { bake(*options); });
}

}  // namespace palpate::cli
