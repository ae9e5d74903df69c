// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_mcap.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "config/scene.hpp"
#include "config/unit_quaternion.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/json_number.hpp"
#include "tools/palpate/mcap_file.hpp"
#include "tools/palpate/report_shapes.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;
using realtime::TraceRecord;

// Foxglove knows its own schemas by name; of ours it reads the fields from the first message.
constexpr const char* kAnyObject = R"({"type":"object"})";
constexpr const char* kTickSchema =
    R"({"type":"object","title":"palpate.Tick",)"
    R"("description":"One tick; SI units unless a name says else"})";
/// Arrows are for the eye: so many a second.
constexpr std::uint64_t kArrowEvery_ns = 20'000'000;

Json vector_json(double x, double y, double z) {
  return {{"x", number(x)}, {"y", number(y)}, {"z", number(z)}};
}
template <class Number>
Json vector_json(const std::array<Number, 3>& v) {
  return vector_json(double(v[0]), double(v[1]), double(v[2]));
}
Json quaternion_json(const Quat& q) {
  return {{"x", number(q.x)}, {"y", number(q.y)}, {"z", number(q.z)}, {"w", number(q.w)}};
}
Json pose_json(const Pose& pose) {
  const Vec3d p = pose.position_m;
  return {{"position", vector_json(p.x, p.y, p.z)},
          {"orientation", quaternion_json(pose.orientation)}};
}
Json time_json(std::uint64_t ns) {
  return {{"sec", ns / 1'000'000'000}, {"nsec", ns % 1'000'000'000}};
}
Json colour_json(double r, double g, double b, double a = 1) {
  return {{"r", r}, {"g", g}, {"b", b}, {"a", a}};
}

Json tick_json(const TraceRecord& r) {
  return {
      {"tick", r.tick},
      {"rendered_force_N", vector_json(r.rendered_force_N)},
      {"rendered_torque_Nm", vector_json(r.rendered_torque_Nm)},
      {"sent_force_N", vector_json(r.sent_force_N)},
      {"sent_torque_Nm", vector_json(r.sent_torque_Nm)},
      {"sent_force_size_N", number(std::hypot(double(r.sent_force_N[0]), double(r.sent_force_N[1]),
                                              double(r.sent_force_N[2])))},
      {"position_m", vector_json(r.position_m)},
      {"min_distance_m", number(r.min_distance_m)},
      {"error_bound_m", number(r.error_bound_m)},
      {"force_bound_N", number(r.force_bound_N)},
      {"s_worst", number(r.s_worst)},
      {"energy_J", number(r.energy_J)},
      {"latency_us", 1e-3 * r.latency_ns},
      {"tick_us", 1e-3 * r.tick_ns},
      {"state_age_us", 1e-3 * r.state_age_ns},
      {"contacts", r.contacts},
      {"clusters", r.clusters},
      {"queries", r.queries},
      {"front_nodes", r.front_nodes},
      {"cut_by_budget", r.truncated != 0},
      {"state", realtime::name(static_cast<realtime::LoopState>(r.state))},
      {"faults", r.faults}};
}

/// False for a tick without a reading.
bool tool_pose(const TraceRecord& r, Pose& out) {
  out.position_m = {r.position_m[0], r.position_m[1], r.position_m[2]};
  out.orientation = {r.orientation[0], r.orientation[1], r.orientation[2], r.orientation[3]};
  return std::isfinite(squared_norm(out.position_m)) && config::make_unit(out.orientation);
}

/// An entity of foxglove.SceneUpdate without anything to see in it.
Json entity_json(const std::string& id, const std::string& frame, std::uint64_t time_ns) {
  Json out = {
      {"timestamp", time_json(time_ns)}, {"frame_id", frame},    {"id", id},
      {"lifetime", time_json(0)},        {"frame_locked", true}, {"metadata", Json::array()}};
  for (const char* kind :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"}) {
    out[kind] = Json::array();
  }
  return out;
}

Json update_json(Json entities) {
  return {{"deletions", Json::array()}, {"entities", std::move(entities)}};
}

Json triangles_json(const ImageView& image, const Pose& pose, const Json& colour) {
  const Shape shape = shape_of(image);
  const image::Header& header = *image.header;
  Json points = Json::array(), indices = Json::array();
  for (const Vec3f& p : shape.points) {
    points.push_back(vector_json(header.centre_m[0] + header.radius_m * double(p.x),
                                 header.centre_m[1] + header.radius_m * double(p.y),
                                 header.centre_m[2] + header.radius_m * double(p.z)));
  }
  for (const auto& face : shape.faces) {
    for (const std::uint32_t corner : face) indices.push_back(corner);
  }
  return {{"pose", pose_json(pose)},
          {"points", std::move(points)},
          {"color", colour},
          {"colors", Json::array()},
          {"indices", std::move(indices)}};
}

/// The bodies, and the radius of the tool's image.
Json bodies_json(const config::Scene& scene, double& tool_radius_m) {
  Json entities = Json::array();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const config::Body& body = scene.bodies[i];
    const ImageFile image(body.image);
    const bool tool = i == scene.tool;
    if (tool) tool_radius_m = image.view().header->radius_m;
    Json entity = entity_json(body.name, tool ? "tool" : "world", 0);
    entity["triangles"].push_back(
        triangles_json(image.view(), tool ? Pose{} : body.pose,
                       tool ? colour_json(0.35, 0.55, 0.85, 0.7) : colour_json(0.75, 0.75, 0.75)));
    entities.push_back(std::move(entity));
  }
  return entities;
}

/// The rotation that turns +x into a direction.
Quat turning_x_to(Vec3d to) {
  const double length = std::sqrt(2 * (1 + to.x));  // of the quaternion before it is divided
  if (!(length > 1e-6)) return {0, 0, 0, 1};        // the opposite: half a turn about z
  return {(1 + to.x) / length, 0, -to.z / length, to.y / length};
}

Json arrow_json(Vec3d at_m, Vec3d force_N, double metres_per_N) {
  const double size_N = norm(force_N);
  if (!(size_N > 0)) return Json::array();
  const double length_m = size_N * metres_per_N;
  return Json::array({{{"pose", pose_json({at_m, turning_x_to((1 / size_N) * force_N)})},
                       {"shaft_length", 0.8 * length_m},
                       {"shaft_diameter", 0.08 * length_m},
                       {"head_length", 0.2 * length_m},
                       {"head_diameter", 0.16 * length_m},
                       {"color", colour_json(0.85, 0.3, 0.1)}}});
}

double largest_sent_N(const Trace& trace) {
  double most = 0;
  for (const TraceRecord& r : trace.records) {
    const auto [x, y, z] = r.sent_force_N;
    most = std::max(most, std::hypot(double(x), double(y), double(z)));
  }
  return most;
}

/// What changed with this tick, in words; empty where nothing did.
std::string news(const TraceRecord& now, const TraceRecord* before) {
  std::string text;
  if (before == nullptr || now.state != before->state) {
    text = realtime::name(static_cast<realtime::LoopState>(now.state));
  }
  const auto added =
      static_cast<std::uint16_t>(now.faults & ~(before == nullptr ? 0u : unsigned{before->faults}));
  for (const std::string_view fault : realtime::names({added})) {
    text += (text.empty() ? "" : ": ") + std::string(fault);
  }
  return text;
}

Json log_json(const std::string& message, const TraceRecord& r) {
  constexpr int kInfo = 2, kError = 4;  // levels of foxglove.Log
  return {{"timestamp", time_json(r.time_ns)},
          {"level", r.faults == 0 ? kInfo : kError},
          {"message", message},
          {"name", "palpate"},
          {"file", ""},
          {"line", 0}};
}

/// The bodies' message, once; the radius that arrows go by, 0 where there are none.
double add_bodies(McapFile& file, std::uint16_t channel, const Trace& trace,
                  const std::filesystem::path& scene, bool quiet) {
  double radius_m = 0;
  try {
    const Json bodies =
        bodies_json(config::load_scene(scene.empty() ? trace.scene : scene), radius_m);
    file.add(channel, trace.records.front().time_ns, update_json(bodies).dump());
  } catch (const std::runtime_error& e) {  // ConfigError and Failure
    if (!scene.empty()) throw;
    if (!quiet) std::cerr << "palpate: no bodies in the MCAP file: " << e.what() << "\n";
  }
  return radius_m;
}

}  // namespace

void write_mcap(const Trace& trace, const std::filesystem::path& scene,
                const std::filesystem::path& target, bool quiet) {
  OutputFile out(target);
  McapFile file(out);
  const std::uint16_t ticks = file.add_channel("/tick", "palpate.Tick", kTickSchema);
  const std::uint16_t frames = file.add_channel("/tf", "foxglove.FrameTransform", kAnyObject);
  const std::uint16_t things = file.add_channel("/scene", "foxglove.SceneUpdate", kAnyObject);
  const std::uint16_t log = file.add_channel("/log", "foxglove.Log", kAnyObject);
  const double radius_m = add_bodies(file, things, trace, scene, quiet);
  const double largest_N = largest_sent_N(trace);
  const double metres_per_N = largest_N > 0 ? radius_m / largest_N : 0;
  std::uint64_t arrow_due_ns = 0;
  const TraceRecord* before = nullptr;
  for (const TraceRecord& r : trace.records) {
    const std::uint64_t t = r.time_ns;
    file.add(ticks, t, tick_json(r).dump());
    Pose pose;
    if (tool_pose(r, pose)) {
      const Vec3d p = pose.position_m;
      file.add(frames, t,
               Json{{"timestamp", time_json(t)},
                    {"parent_frame_id", "world"},
                    {"child_frame_id", "tool"},
                    {"translation", vector_json(p.x, p.y, p.z)},
                    {"rotation", quaternion_json(pose.orientation)}}
                   .dump());
      if (metres_per_N > 0 && t >= arrow_due_ns) {
        arrow_due_ns = t + kArrowEvery_ns;
        const auto [x, y, z] = r.sent_force_N;
        Json entity = entity_json("force", "world", t);
        entity["arrows"] = arrow_json(p, {double(x), double(y), double(z)}, metres_per_N);
        file.add(things, t, update_json(Json::array({entity})).dump());
      }
    }
    if (const std::string words = news(r, before); !words.empty()) {
      file.add(log, t, log_json(words, r).dump());
    }
    before = &r;
  }
  file.finish();
  out.commit();
}

}  // namespace palpate::cli
