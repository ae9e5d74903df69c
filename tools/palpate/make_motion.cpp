// SPDX-License-Identifier: GPL-3.0-or-later
// palpate make-motion: writes a benchmark motion for a scene.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/motion_placing.hpp"
#include "tools/palpate/output_file.hpp"
#include "tools/palpate/poses.hpp"

namespace palpate::cli {
namespace {

constexpr std::size_t kStretch = 10;  // ticks

struct MakeMotionOptions {
  std::string name, scene, poses;
  std::size_t ticks = 2000;
  std::size_t one_in = 1;
  std::uint64_t seed = 1;
  bool quiet = false;
};

std::string motion_table() {
  std::string table =
      "Motions, for any scene of two bodies; each moves and presses as suits one of "
      "config/scenes:\n";
  for (const Motion& motion : motions()) {
    std::string line = "  " + std::string(motion.name);
    line.resize(16, ' ');
    line += motion.scene;
    line.resize(38, ' ');
    table += line + std::string(motion.what) + "\n";
  }
  return table +
         "A tick is a millisecond. Gaps run from 0.1 delta below touch to just within the scene's\n"
         "delta_m, and beyond it where the motion taps; parts that interlock are pressed from "
         "side\n"
         "to side in their clearance. Images need the regions engine's part, as bake makes them.";
}

const Motion& motion_named(const std::string& name) {
  const auto all = motions();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Motion& m) { return m.name == name; });
  if (found == all.end()) {
    throw Failure(kUsage, "unknown motion", name,
                  "choose one of those that 'palpate make-motion --help' lists");
  }
  return *found;
}

void make_motion(const MakeMotionOptions& options) {
  const Motion& motion = motion_named(options.name);
  const config::Scene scene = config::load_scene(options.scene);
  require_writable(options.poses);
  const bake::Progress show = progress(options.quiet);
  MotionPlacing placing(scene);
  std::string text = std::string(kPosesHeader) + "\n";
  for (std::size_t tick = 0; tick < options.ticks; ++tick) {
    if (tick / kStretch % options.one_in != 0) continue;
    const double share = double(tick) / double(options.ticks);
    const Pose pose = placing.place(waymark(motion, share, options.seed), motion.closing);
    text += pose_row(1e-3 * double(tick), scene.bodies[scene.tool].name, pose);
    show("place", share);
  }
  write_file(options.poses, text);
}

}  // namespace

void add_make_motion(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("make-motion", "Write a benchmark motion for a scene (CSV, poses)");
  const auto options = std::make_shared<MakeMotionOptions>();
  command->add_option("NAME", options->name, "One of the motions below")->required();
  command->add_option("SCENE", options->scene, "scene file (TOML); its images must be there")
      ->required();
  command->add_option("-o,--output", options->poses, "CSV file to write")
      ->required()
      ->check(named_as(".csv"));
  command->add_option("--ticks", options->ticks, "How many")
      ->check(number_between(1, 1e7))
      ->capture_default_str();
  command
      ->add_option(
          "--one-in", options->one_in,
          "Of this many stretches of ten ticks write one: a sample of the motion at its own "
          "speed")
      ->check(number_between(1, 1e7))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Changes phases")
      ->check(number_between(0, 1e18))
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->footer(motion_table());
  command->callback([options] { make_motion(*options); });
}

}  // namespace palpate::cli
