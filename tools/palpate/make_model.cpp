// SPDX-License-Identifier: GPL-3.0-or-later
// palpate make-model: writes a procedural benchmark mesh.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host_bake/mesh/read.hpp"
#include "host_bake/models/models.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"

namespace palpate::cli {
namespace {

struct MakeModelOptions {
  std::string name;
  std::string mesh;
  std::size_t triangles = 0;  ///< 0: the model's default
  std::uint64_t seed = 1;
  bool quiet = false;
};

std::string model_table() {
  std::string table = "Models (triangles unless told otherwise, at least; radius):\n";
  for (const bake::ModelInfo& model : bake::models()) {
    char line[160];
    std::snprintf(line, sizeof line, "  %-16s%8zu %6zu %7.1f mm  %s\n",
                  std::string(model.name).c_str(), model.default_triangles, model.least_triangles,
                  1000.0 * model.radius_m, std::string(model.what).c_str());
    table += line;
  }
  return table +
         "Jaws, head and cup, ball and shell, screw and nut interlock as written when made with\n"
         "the same seed and equal triangle counts, or any counts from 20000.";
}

/// What the library would refuse as an input is here a mistake on the command line.
void require_possible(const MakeModelOptions& options) {
  const auto known = bake::models();
  const auto model = std::find_if(known.begin(), known.end(),
                                  [&](const bake::ModelInfo& m) { return m.name == options.name; });
  if (model == known.end()) {
    throw Failure(kUsage, "unknown model", options.name,
                  "choose one of those that 'palpate make-model --help' lists");
  }
  const bool possible =
      options.triangles >= model->least_triangles && options.triangles <= bake::kMostModelTriangles;
  if (options.triangles != 0 && !possible) {
    throw Failure(kUsage, "impossible triangle count",
                  "--triangles " + std::to_string(options.triangles),
                  options.name + " takes " + std::to_string(model->least_triangles) + " to " +
                      std::to_string(bake::kMostModelTriangles));
  }
}

void make_model(const MakeModelOptions& options) {
  require_possible(options);
  const bake::Progress progress = cli::progress(options.quiet);
  progress("make", 0);
  const bake::Mesh mesh = bake::make_model(options.name, options.triangles, options.seed);
  progress("write", 0);
  const std::vector<std::byte> ply = bake::to_ply(mesh);
  write_file(options.mesh, std::span<const std::byte>(ply));
}

}  // namespace

void add_make_model(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("make-model", "Write a procedural benchmark mesh (binary PLY, metres)");
  const auto options = std::make_shared<MakeModelOptions>();
  command->add_option("name", options->name, "One of the models below")->required();
  command->add_option("-o,--output", options->mesh, "PLY file to write")
      ->required()
      ->check(named_as(".ply"));
  // Without this -1 would be read as the largest number there is.
  const CLI::Validator not_negative(
      [](std::string& text) {
        return text.starts_with('-') ? text + " is negative" : std::string();
      },
      "");
  command->add_option("--triangles", options->triangles, "How many, met within 2 %")
      ->check(not_negative);
  command->add_option("--seed", options->seed, "Changes textures and places")
      ->check(not_negative)
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->footer(model_table());
  command->callback([options] { make_model(*options); });
}

}  // namespace palpate::cli
