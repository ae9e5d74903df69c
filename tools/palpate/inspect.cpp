// SPDX-License-Identifier: GPL-3.0-or-later
// palpate inspect: what an image holds, whether its invariants are true, and its levels as meshes.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_bake/bake.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/image_json.hpp"
#include "tools/palpate/image_text.hpp"
#include "tools/palpate/level_picture.hpp"
#include "tools/palpate/level_ply.hpp"
#include "tools/palpate/output_file.hpp"
#include "tools/picture/png.hpp"

namespace palpate::cli {
namespace {

struct InspectOptions {
  std::string image;
  std::string mesh;                    ///< where the exported level goes
  std::optional<std::uint32_t> level;  ///< to export
  std::string picture;                 ///< empty: none
  std::array<double, 3> from = {1, -2, 1.5};
  bool json = false;
  bool verify = false;
};

void check_level(const InspectOptions& options, const ImageView& image) {
  if (!options.level || *options.level < image.levels.size()) return;
  throw Failure(kUsage, "no such level", "--export-lod " + std::to_string(*options.level),
                "the image has levels 0 to " + std::to_string(image.levels.size() - 1));
}

nlohmann::json to_json(const std::vector<bake::Proof>& proofs) {
  nlohmann::json list = nlohmann::json::array();
  for (const bake::Proof& proof : proofs) {
    list.push_back(
        {{"invariant", proof.invariant}, {"holds", proof.holds}, {"found", proof.found}});
  }
  return list;
}

void print(const std::vector<bake::Proof>& proofs) {
  if (!proofs.empty()) std::cout << "\n";
  for (const bake::Proof& proof : proofs) {
    std::cout << (proof.holds ? "holds  " : "FAILS  ") << proof.invariant << ": " << proof.found
              << "\n";
  }
}

void require_all(const std::vector<bake::Proof>& proofs, const std::string& file) {
  const auto failed = std::count_if(proofs.begin(), proofs.end(),
                                    [](const bake::Proof& proof) { return !proof.holds; });
  if (failed == 0) return;
  throw Failure(
      kRefused,
      std::to_string(failed) + " of " + std::to_string(proofs.size()) + " invariants do not hold",
      file, "bake the mesh again");
}

/// Where the picture is seen from.
Vec3d direction(const InspectOptions& options) {
  const auto& [x, y, z] = options.from;
  if (x != 0 || y != 0 || z != 0) return {x, y, z};
  throw Failure(kUsage, "no direction", "--from 0 0 0", "give a vector that is not zero");
}

void write_outputs(const InspectOptions& options, const ImageView& image) {
  std::optional<OutputFile> mesh, picture;
  if (options.level) mesh.emplace(options.mesh, level_ply(image, *options.level));
  if (!options.picture.empty()) {
    picture.emplace(options.picture,
                    picture::to_png(level_picture(image, shown_levels(image), direction(options))));
  }
  if (mesh) mesh->commit();
  if (picture) picture->commit();
}

void inspect(const InspectOptions& options) {
  const ImageFile file(options.image);
  const ImageView& image = file.view();
  check_level(options, image);
  (void)direction(options);
  std::vector<bake::Proof> proofs;
  if (options.verify) proofs = bake::verify(image);
  if (options.json) {
    nlohmann::json json = image_json(image);
    if (options.verify) json["verify"] = to_json(proofs);
    std::cout << json.dump(2) << "\n";
  } else {
    std::cout << image_text(image);
    print(proofs);
  }
  require_all(proofs, options.image);
  write_outputs(options, image);
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand("inspect", "Show what an image holds and prove it");
  command->add_option("IMAGE", options->image, "Image made by bake")->required();
  command->add_flag("--json", options->json, "One JSON object instead of text");
  command->add_flag("--verify", options->verify,
                    "Prove the geometric invariants of docs/FORMAT.md one by one; exit status 3 "
                    "where one fails");
  auto* level = command->add_option("--export-lod", options->level,
                                    "Write this level as a mesh, 0 is the finest");
  auto* mesh = command->add_option("-o,--output", options->mesh, "PLY file for --export-lod")
                   ->check(named_as(".ply"));
  level->needs(mesh);
  mesh->needs(level);
  auto* picture = command
                      ->add_option("--picture", options->picture,
                                   "Write a PNG picture of the original surface, three "
                                   "simplified and two free levels")
                      ->check(named_as(".png"));
  command
      ->add_option("--from", options->from,
                   "Where the picture is seen from, X Y Z in body axes: a direction")
      ->check(number_between(-1e9, 1e9))
      ->needs(picture)
      ->capture_default_str();
  command->callback([options] { inspect(*options); });
}

}  // namespace palpate::cli
