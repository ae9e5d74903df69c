// SPDX-License-Identifier: GPL-3.0-or-later
// palpate new-scene: two meshes, baked and placed just apart.
#include "tools/palpate/new_scene.hpp"
#include "tools/palpate/file_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <memory>

#include "config/scene.hpp"
#include "tools/palpate/bake_mesh.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/mesh_size.hpp"
#include "tools/palpate/motion_placing.hpp"
#include "tools/palpate/output_file.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// What the example scenes of things of a few centimetres have, for things of any size.
constexpr double kDeltaOfRadius = 0.01;  // of the smaller body
constexpr double kClusterOfDelta = 6;
constexpr double kForceAtTouch_N = 0.3;  // stiffness times delta, where stiffness allows it
constexpr double kLeastStiffness = 100;  // N/m: softer feels like nothing
constexpr double kMostStiffness = 600;   // N/m: what common devices hold still at 1 kHz
constexpr double kSlideOfSide = 0.1;
constexpr int kMostApproaches = 16;

struct BodyOfScene {
  std::string mesh;  ///< file
  std::string name;
  MeshBox box_m;
  Baked baked;
  fs::path image;
};

/// The file's name without what a pose file or a TOML string would stumble over.
std::string body_name(const fs::path& mesh) {
  std::string name = mesh.stem().string();
  for (char& c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  return name.empty() ? "body" : name;
}

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// Two digits: nobody reads more of a tolerance.
double rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return std::stod(text);
}

void scale(bake::Mesh& mesh, double factor) {
  for (bake::Point& p : mesh.points) {
    for (double& coordinate : p) coordinate *= factor;
  }
}

std::string unit_line(const std::string& file, const MeshBox& box, double unit_m, bool guessed) {
  const std::string unit = unit_m == 1               ? "metres"
                           : unit_m == kMillimetre_m ? "millimetres"
                                                     : short_text(unit_m) + " m";
  return file + ": " + sides_text(box) + ", in " + unit +
         (guessed ? " by its size; --unit-scale S says otherwise" : "");
}

class SceneMaker {
 public:
  SceneMaker(const NewSceneOptions& options, const bake::Progress& progress)
      : options_(options), progress_(progress) {
    bodies_[0].mesh = options.tool;
    bodies_[1].mesh = options.other;
    name_bodies();
  }

  NewScene make() {
    require_writable(options_.scene);
    read_and_bake();
    write_images();
    choose_way();
    come_near();
    write_file(options_.scene, scene_text());
    out_.said.push_back(options_.scene.string() + ": " + bodies_[0].name + " " + "just off " +
                        bodies_[1].name + " along +" + "xyz"[axis_] + ", delta_m = " +
                        short_text(delta_m_) + ", stiffness_N_per_m = " + short_text(stiffness()));
    return std::move(out_);
  }

 private:
  void name_bodies() {
    for (BodyOfScene& body : bodies_) body.name = body_name(body.mesh);
    BodyOfScene& other = bodies_[1];
    one_mesh_ = bodies_[0].mesh == other.mesh;
    if (bodies_[0].name == other.name) other.name += "_2";
    const fs::path folder = options_.scene.parent_path();
    for (BodyOfScene& body : bodies_) body.image = folder / (body.name + ".palp");
    if (one_mesh_) other.image = bodies_[0].image;
  }

  void read_and_bake() {
    std::array<bake::ReadMesh, 2> read;
    for (std::size_t i = 0; i < 2; ++i) {
      progress_("read", 0);
      read[i] = bake::read_mesh(bodies_[i].mesh);
      bodies_[i].box_m = box_of(read[i].mesh);
    }
    const std::array<MeshBox, 2> boxes = {bodies_[0].box_m, bodies_[1].box_m};
    for (std::size_t i = 0; i < 2; ++i) {
      const double unit_m = options_.unit_scale.value_or(guessed_unit_m(boxes[i], boxes[1 - i]));
      out_.said.push_back(unit_line(bodies_[i].mesh, boxes[i], unit_m, !options_.unit_scale));
      scale(read[i].mesh, unit_m);
      bake_one(bodies_[i], std::move(read[i]));
    }
  }

  void bake_one(BodyOfScene& body, bake::ReadMesh read) {
    body.box_m = box_of(read.mesh);
    if (one_mesh_ && &body == &bodies_[1]) return;
    bake::BakeOptions how;
    how.engine = bake::ForEngine::regions;
    how.threads = options_.threads;
    body.baked = bake_mesh(std::move(read), body.mesh, {.repair = true}, how, progress_);
    for (const std::string& line : body.baked.repairs) {
      out_.said.push_back(body.mesh + ": " + line);
    }
  }

  void write_images() {
    std::vector<std::unique_ptr<OutputFile>> files;
    for (const BodyOfScene& body : bodies_) {
      if (body.baked.bytes.empty()) continue;
      files.push_back(std::make_unique<OutputFile>(body.image, body.baked.bytes));
    }
    for (const auto& file : files) file->commit();
    double radius_m = ImageFile(bodies_[0].image).view().header->radius_m;
    radius_m = std::min(radius_m, ImageFile(bodies_[1].image).view().header->radius_m);
    delta_m_ = rounded(kDeltaOfRadius * radius_m);
  }

  /// Along the axis in which both together take least room, and where a slide goes.
  void choose_way() {
    const bake::Point a = bodies_[0].box_m.sides(), b = bodies_[1].box_m.sides();
    const auto room = [&](std::size_t i) { return a[i] + b[i]; };
    for (std::size_t i = 1; i < 3; ++i) {
      if (room(i) < room(axis_)) axis_ = i;
    }
    std::size_t aside = (axis_ + 1) % 3;
    if (room((axis_ + 2) % 3) > room(aside)) aside = (axis_ + 2) % 3;
    out_.across = unit(aside);
    out_.slide_m = kSlideOfSide * std::min(a[aside], b[aside]);
    out_.start.approach = -unit(axis_);
    out_.start.gap = 1;
  }

  static Vec3d unit(std::size_t axis) {
    return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
  }

  static Vec3d vector(const bake::Point& p) { return {p[0], p[1], p[2]}; }

  /// The other's middle is the world's; the tool's box stands above its box.
  [[nodiscard]] Vec3d other_m() const { return -vector(bodies_[1].box_m.centre()); }
  [[nodiscard]] Vec3d apart() const {
    return room_m() * unit(axis_) - vector(bodies_[0].box_m.centre());
  }
  [[nodiscard]] double room_m() const {
    return (bodies_[0].box_m.sides()[axis_] + bodies_[1].box_m.sides()[axis_]) / 2 + delta_m_;
  }

  /// As the file will say it.
  [[nodiscard]] config::Scene scene() const {
    config::Scene scene;
    scene.file = options_.scene;
    scene.settings.engine = EngineKind::regions;
    scene.settings.delta_m = delta_m_;
    for (std::size_t i = 0; i < 2; ++i) {
      const config::Role role = i == 0 ? config::Role::tool : config::Role::fixed;
      const Vec3d at_m = i == 0 ? apart() : other_m();
      scene.bodies.push_back({bodies_[i].name, bodies_[i].image, role, {at_m, {}}});
    }
    scene.pairs = {{0, 1}};
    scene.friction = {0};
    return scene;
  }

  /// Down from where the boxes are apart until the surfaces are delta apart; where they never are,
  /// as of a rod above a ring, it stays.
  void come_near() {
    const config::Scene boxes_apart = scene();
    tool_m_ = apart();
    Waymark& at = out_.start;
    at.pose.position_m = tool_m_ - other_m();
    MotionPlacing placing(boxes_apart);
    double last_m = -1;
    for (int i = 0; i < kMostApproaches; ++i) {
      progress_("place", double(i) / kMostApproaches);
      const Vec3d now_m = placing.place(at, Closing::from_outside).position_m;
      const double come_m = dot(now_m - tool_m_, at.approach);
      if (come_m > 2 * room_m()) return;
      if (come_m - last_m < delta_m_ / 2) {
        tool_m_ = now_m;
        at.pose.position_m = now_m - other_m();
        return;
      }
      last_m = come_m;
    }
  }

  [[nodiscard]] double stiffness() const {
    return rounded(std::clamp(kForceAtTouch_N / delta_m_, kLeastStiffness, kMostStiffness));
  }

  [[nodiscard]] std::string body_text(std::size_t i, Vec3d at_m) const {
    char position[96];
    std::snprintf(position, sizeof position, "[%.9g, %.9g, %.9g]", at_m.x + 0.0, at_m.y + 0.0,
                  at_m.z + 0.0);
    return "\n[[body]]\nname = \"" + bodies_[i].name + "\"\nimage = \"" +
           bodies_[i].image.filename().string() + "\"\nrole = \"" + (i == 0 ? "tool" : "fixed") +
           "\"\nposition = " + position + "\n";
  }

  [[nodiscard]] std::string scene_text() const {
    return "# Made by palpate new-scene; every key is in config/README.md.\n\n[engine]\nengine = "
           "\"regions\"\ndelta_m = " +
           short_text(delta_m_) +
           "\nbudget_us = 400\n\n[force]\nstiffness_N_per_m = " + short_text(stiffness()) +
           "\ncluster_radius_m = " + short_text(rounded(kClusterOfDelta * delta_m_)) + "\n" +
           body_text(0, tool_m_) + body_text(1, other_m());
  }

  const NewSceneOptions& options_;
  const bake::Progress& progress_;
  std::array<BodyOfScene, 2> bodies_;  // the tool first
  bool one_mesh_ = false;
  double delta_m_ = 0;
  std::size_t axis_ = 0;
  Vec3d tool_m_{};
  NewScene out_;
};

void new_scene(const NewSceneOptions& options, bool quiet) {
  NewScene made;
  {
    const bake::Progress show = progress(quiet);
    made = make_scene(options, show);
  }
  if (quiet) return;
  for (const std::string& line : made.said) std::cout << line << "\n";
  std::cout << "Next: palpate run " << options.scene.string()
            << " --poses MOTION.csv; palpate try makes a motion too\n";
}

}  // namespace

NewScene make_scene(const NewSceneOptions& options, const bake::Progress& progress) {
  return SceneMaker(options, progress).make();
}

void add_unit_scale(CLI::App& command, std::optional<double>& unit_scale) {
  command
      .add_option("--unit-scale", unit_scale,
                  "Metres of one unit of either file; default: 0.001 (millimetres) where either is "
                  "more than 10 across, but for one that would then be less than a millimetre; "
                  "else 1")
      ->check(number_between(1e-15, 1e15));
}

void add_new_scene(CLI::App& app) {
  struct Options {
    NewSceneOptions scene;
    bool quiet = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "new-scene", "Make a scene of two meshes: repaired, baked, placed just apart");
  command->add_option("TOOL", options->scene.tool, "Mesh that the hand holds (OBJ, PLY, STL, OFF)")
      ->required();
  command->add_option("OTHER", options->scene.other, "Mesh that it touches")->required();
  command
      ->add_option("-o,--output", options->scene.scene,
                   "Scene file to write; the images go beside it")
      ->required()
      ->check(named_as(".toml"));
  add_unit_scale(*command, options->scene.unit_scale);
  command->add_option("--threads", options->scene.threads, "Threads to use, 0: all cores")
      ->check(CLI::Range(0u, kMaxThreads))
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options] { new_scene(options->scene, options->quiet); });
}

}  // namespace palpate::cli
