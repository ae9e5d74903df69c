// SPDX-License-Identifier: GPL-3.0-or-later
// palpate try: two meshes, a motion that touches, a run and its report, in one command.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/browser.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/new_scene.hpp"
#include "tools/palpate/report_page.hpp"
#include "tools/palpate/touch_motion.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

struct TryOptions {
  NewSceneOptions scene;
  fs::path folder;
  double seconds = 10;
  bool no_browser = false;
  bool quiet = false;

  [[nodiscard]] fs::path file(const char* name) const { return folder / name; }
};

void make_try_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Failure(kOther, "cannot make the folder (" + error.message() + ")", folder.string(),
                  "give a place that is writable and no file");
  }
}

/// One of the other commands, said as a user would type it.
void run_command(const TryOptions& options, void (*add)(CLI::App&),
                 std::vector<std::string> words) {
  if (options.quiet) {
    words.emplace_back("--quiet");
  } else {
    std::cout << "\n$ palpate";
    for (const std::string& word : words) std::cout << " " << word;
    std::cout << "\n" << std::flush;
  }
  CLI::App app;
  add(app);
  app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
}

void make_scene_and_motion(const TryOptions& options) {
  const bake::Progress show = progress(options.quiet);
  const NewScene made = make_scene(options.scene, show);
  const config::Scene scene = config::load_scene(options.scene.scene);
  write_file(options.file("motion.csv"), touch_motion(scene, made, options.seconds, show));
  if (options.quiet) return;
  for (const std::string& line : made.said) std::cout << line << "\n";
  std::cout << options.file("motion.csv").string() << ": down, touch, slide, up\n";
}

/// A build without pages has everything else.
bool has_pages() {
  try {
    static_cast<void>(report_page());
    static_cast<void>(live_page());
    return true;
  } catch (const Failure& e) {
    std::cerr << "palpate: no live view and no report: " << e.what() << "\n";
    return false;
  }
}

void try_meshes(TryOptions options) {
  if (options.folder.empty()) {
    options.folder = "try-" + fs::path(options.scene.tool).stem().string() + "-" +
                     fs::path(options.scene.other).stem().string();
  }
  make_try_folder(options.folder);
  options.scene.scene = options.file("scene.toml");
  make_scene_and_motion(options);
  const bool pages = has_pages();
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g", options.seconds);
  std::vector<std::string> run = {"run",       options.scene.scene.string(),
                                  "--poses",   options.file("motion.csv").string(),
                                  "--seconds", seconds,
                                  "-o",        options.file("run.trace").string()};
  if (pages) run.emplace_back("--view");
  if (pages && options.no_browser) run.emplace_back("--no-browser");
  run_command(options, add_run, run);
  if (!pages) return;
  const std::string report = options.file("report.html").string();
  run_command(options, add_report, {"report", options.file("run.trace").string(), "-o", report});
  std::cout << "\nReport: " << fs::absolute(report).string() << "\n";
  std::cout << "Next: palpate run " << options.scene.scene.string()
            << " --device mouse --view, and pull the tool yourself\n";
  if (!options.no_browser) open_on_screen(report);
}

}  // namespace

void add_try(CLI::App& app) {
  const auto options = std::make_shared<TryOptions>();
  CLI::App* command = app.add_subcommand(
      "try",
      "Two meshes of yours, felt by the mock device: scene, motion, run with a live view, report");
  command->add_option("TOOL", options->scene.tool, "Mesh that the hand holds (OBJ, PLY, STL, OFF)")
      ->required();
  command->add_option("OTHER", options->scene.other, "Mesh that it touches")->required();
  command->add_option("-o,--output", options->folder,
                      "Folder for scene, images, motion, trace and report; default: "
                      "try-TOOL-OTHER");
  command->add_option("--seconds", options->seconds, "Length of the motion and the run")
      ->check(number_between(0.1, 600))
      ->capture_default_str();
  add_unit_scale(*command, options->scene.unit_scale);
  command->add_option("--threads", options->scene.threads, "Threads to bake with, 0: all cores")
      ->check(CLI::Range(0u, kMaxThreads))
      ->capture_default_str();
  command->add_flag("--no-browser", options->no_browser,
                    "Do not open the live view and the report");
  command->add_flag("--quiet", options->quiet, "Print the summary of the run and the report alone");
  command->callback([options] { try_meshes(*options); });
}

}  // namespace palpate::cli
