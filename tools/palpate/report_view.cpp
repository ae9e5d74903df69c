// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view's part of a report's data.
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/palpate/command.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/report_json.hpp"
#include "tools/palpate/report_shapes.hpp"
#include "tools/realtime/contact_force.hpp"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;
using Wanted = std::map<std::uint32_t, std::uint32_t>;

/// One side of a contact.
struct Side {
  std::uint32_t body = 0, piece = 0;
};

/// Images of the scene, each once, and which one each body shows.
struct Images {
  std::vector<ImageFile> files;
  std::vector<std::filesystem::path> paths;
  std::vector<std::uint32_t> of_body;
};

Images open_images(const config::Scene& scene) {
  Images out;
  for (const config::Body& body : scene.bodies) {
    const auto known = std::find(out.paths.begin(), out.paths.end(), body.image);
    out.of_body.push_back(static_cast<std::uint32_t>(known - out.paths.begin()));
    if (known != out.paths.end()) continue;
    out.paths.push_back(body.image);
    out.files.emplace_back(body.image);
  }
  return out;
}

Side side_a(const config::Scene& scene, const Contact& c) {
  return {scene.pairs[c.pair].a, c.piece_a};
}
Side side_b(const config::Scene& scene, const Contact& c) {
  return {scene.pairs[c.pair].b, c.piece_b};
}

/// [images] the pieces that contacts lie on, and how often.
std::vector<Wanted> wanted_pieces(const config::Scene& scene, const Images& images,
                                  const std::vector<Contact>& contacts) {
  std::vector<Wanted> wanted(images.files.size());
  for (const Contact& c : contacts) {
    for (const Side side : {side_a(scene, c), side_b(scene, c)}) {
      const std::uint32_t image = images.of_body[side.body];
      if (side.piece >= images.files[image].view().pieces.size()) {
        throw Failure(kRefused,
                      "a contact lies on piece " + std::to_string(side.piece) +
                          ", which the image does not have",
                      images.paths[image].string(), "replay the poses with this image");
      }
      ++wanted[image][side.piece];
    }
  }
  return wanted;
}

Json image_json(const ImageFile& file, const PieceShapes& pieces) {
  const image::Header& header = *file.view().header;
  const Shape shape = shape_of(file.view());
  std::vector<std::uint32_t> levels;
  for (const std::uint32_t piece : pieces.pieces) levels.push_back(file.view().pieces[piece].level);
  return {{"centre_m", header.centre_m},
          {"radius_m", header.radius_m},
          {"levels", file.view().levels.size()},
          {"level", shape.level},
          {"triangles", shape.faces.size()},
          {"source_triangles", header.source_triangles},
          {"points", packed(shape.points)},
          {"faces", packed(shape.faces)},
          {"pieces",
           {{"index", packed(pieces.pieces)},
            {"level", packed(levels)},
            {"starts", packed(pieces.starts)},
            {"corners", packed(pieces.corners)}}}};
}

/// [frames] each body's pose; float32 of what is left of the scene's own origin.
std::vector<std::string> packed_tracks(const ReportScene& view, const Frames& frames,
                                       Vec3d origin_m) {
  std::vector<Pose> poses;
  for (const config::Body& body : view.scene.bodies) poses.push_back(body.pose);
  std::vector<std::vector<float>> tracks(poses.size());
  for (std::size_t tick = 0; tick < frames.ticks; ++tick) {
    view.track.apply(tick, poses);
    if (tick % frames.stride != 0) continue;
    for (std::size_t body = 0; body < poses.size(); ++body) {
      const Vec3d p = poses[body].position_m - origin_m;
      const Quat q = poses[body].orientation;
      for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) {
        tracks[body].push_back(static_cast<float>(value));
      }
    }
  }
  std::vector<std::string> out;
  out.reserve(tracks.size());
  for (const std::vector<float>& track : tracks) out.push_back(packed(track));
  return out;
}

/// Of what is drawn, in world axes.
Vec3d origin_of(const config::Scene& scene) { return scene.bodies[scene.tool].pose.position_m; }

const char* role_name(config::Role role) {
  return role == config::Role::tool ? "tool" : role == config::Role::moved ? "moved" : "fixed";
}

std::vector<Vec3f> to_floats(const std::vector<Vec3d>& vectors) {
  std::vector<Vec3f> out;
  out.reserve(vectors.size());
  for (const Vec3d v : vectors) {
    out.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  }
  return out;
}

Json contacts_json(const config::Scene& scene, const Images& images,
                   const std::vector<PieceShapes>& pieces, const ShownContacts& shown,
                   Vec3d origin_m) {
  constexpr std::uint32_t kNotShown = 0xffffffffu;
  std::vector<Vec3d> points;             // a, b of each
  std::vector<float> distances, forces;  // of each
  std::vector<std::uint32_t> sides;      // body, place of the piece, level; of a, then of b of each
  const auto add_side = [&](const Side side, std::uint32_t level) {
    const auto& place = pieces[images.of_body[side.body]].place;
    const auto found = place.find(side.piece);
    sides.insert(sides.end(), {side.body, found == place.end() ? kNotShown : found->second, level});
  };
  for (const Contact& c : shown.contacts) {
    points.push_back(c.point_a_m - origin_m);
    points.push_back(c.point_b_m - origin_m);
    distances.push_back(static_cast<float>(c.distance_m));
    forces.push_back(static_cast<float>(realtime::contact_force(c, scene.settings)));
    add_side(side_a(scene, c), c.level_a);
    add_side(side_b(scene, c), c.level_b);
  }
  return {{"starts", packed(shown.starts)},      {"found", packed(shown.found)},
          {"points", packed(to_floats(points))}, {"distances", packed(distances)},
          {"forces_N", packed(forces)},          {"sides", packed(sides)}};
}

/// What images are drawn as, `pieces` with them.
Json images_json(const Images& images, const std::vector<Wanted>& wanted,
                 std::vector<PieceShapes>& out_pieces) {
  Json list = Json::array();
  for (std::size_t i = 0; i < images.files.size(); ++i) {
    out_pieces.push_back(piece_shapes(images.files[i].view(), wanted[i]));
    list.push_back(image_json(images.files[i], out_pieces.back()));
  }
  return list;
}

Json bodies_json(const ReportScene& view, const Frames& frames, const Images& images) {
  const config::Scene& scene = view.scene;
  const std::vector<std::string> tracks = packed_tracks(view, frames, origin_of(scene));
  Json bodies = Json::array();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    bodies.push_back({{"name", scene.bodies[i].name},
                      {"role", role_name(scene.bodies[i].role)},
                      {"image", images.of_body[i]},
                      {"track", tracks[i]}});
  }
  return bodies;
}

}  // namespace

nlohmann::ordered_json view_json(const ReportScene& view, const ShownContacts& contacts,
                                 const Frames& frames) {
  const config::Scene& scene = view.scene;
  const Images images = open_images(scene);
  std::vector<PieceShapes> pieces;
  const Json image_list =
      images_json(images, wanted_pieces(scene, images, contacts.contacts), pieces);
  return {{"origin", contacts.origin},
          {"delta_m", scene.settings.delta_m},
          {"tool", scene.tool},
          {"images", image_list},
          {"bodies", bodies_json(view, frames, images)},
          {"force_N", packed(to_floats(contacts.force_N))},
          {"contacts", contacts_json(scene, images, pieces, contacts, origin_of(scene))}};
}

nlohmann::ordered_json scene_json(const config::Scene& scene) {
  const Images images = open_images(scene);
  std::vector<PieceShapes> no_pieces;
  const Json image_list = images_json(images, std::vector<Wanted>(images.files.size()), no_pieces);
  ReportScene still;
  still.scene = scene;
  still.track.ticks.emplace_back();
  return {{"delta_m", scene.settings.delta_m},
          {"tool", scene.tool},
          {"images", image_list},
          {"bodies", bodies_json(still, frames_of(1), images)}};
}

}  // namespace palpate::cli
