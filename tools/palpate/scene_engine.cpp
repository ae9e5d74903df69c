// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/scene_engine.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include "config/scene_keys.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {

SceneEngine::SceneEngine(const config::Scene& scene) : config_(scene), limits_(scene.limits) {
  open_images();
  const std::size_t bytes = required_bytes(scene_, limits_, config_.settings.engine);
  if (bytes == 0) {
    throw Failure(kUsage, "the engine cannot work within these [limits]", config_.file.string(),
                  "raise or remove nodes, contacts and clusters");
  }
  require_memory(image_bytes_ + bytes);
  allocate(bytes);
  restart();
}

bool SceneEngine::fits(std::uintmax_t bytes) const {
  return static_cast<double>(bytes) * 1e-6 <= config_.max_memory_MB;
}

void SceneEngine::require_memory(std::uintmax_t bytes) const {
  if (fits(bytes)) return;
  const std::string needed_MB = config::to_text(static_cast<double>(bytes) * 1e-6);
  throw Failure(kRefused, "the scene needs " + needed_MB + " MB of memory, more than it allows",
                config_.file.string(), "raise max_memory_MB in [limits] or use smaller images");
}

void SceneEngine::open_images() {
  for (const config::Body& body : config_.bodies) {
    auto found = images_.find(body.image);
    if (found == images_.end()) {
      // Before the image is read: what is too large may be too large to read. What cannot be read
      // has no size here, and ImageFile says why.
      std::error_code no_size;
      const std::uintmax_t size = std::filesystem::file_size(body.image, no_size);
      if (!no_size) require_memory(image_bytes_ + size);
      found = images_.emplace(body.image, ImageFile(body.image)).first;
      image_bytes_ += found->second.bytes().size();
    }
    bodies_.push_back(found->second.view());
  }
  scene_ = {bodies_, config_.pairs, config_.tool};
}

void SceneEngine::allocate(std::size_t bytes) {
  memory_.reset();  // first: old and new need not fit together
  memory_.reset(new (std::align_val_t(image::kAlignment)) std::byte[bytes]);
  engine_bytes_ = bytes;
}

bool SceneEngine::grow() {
  Limits larger = limits_;
  larger.nodes *= 2;
  larger.contacts *= 2;
  larger.clusters *= 2;
  const std::size_t bytes =
      larger.nodes > limits_.nodes ? required_bytes(scene_, larger, config_.settings.engine) : 0;
  if (bytes == 0 || !fits(image_bytes_ + bytes)) return false;
  limits_ = larger;
  allocate(bytes);
  restart();
  return true;
}

void SceneEngine::restart() {
  const std::span<std::byte> memory(memory_.get(), engine_bytes_);
  Settings settings = config_.settings;
  if (config_.kappa) settings.kappa = *config_.kappa;
  const Status status = create(scene_, settings, limits_, memory, engine_);
  if (status == Status::ok) return;
  const bool image = status == Status::image_missing_section ||
                     status == Status::image_over_limit || status == Status::image_too_coarse;
  throw Failure(image ? kRefused : kUsage,
                std::string("the engine refuses the scene (") + describe(status) + ")",
                config_.file.string(),
                status == Status::image_too_coarse
                    ? "bake the images without --s0-min and --max-bytes, or with a smaller s0 and "
                      "--partner-area, and with a --max-deviation far below delta_m; palpate "
                      "inspect says what an image serves"
                    : "check [engine], [force], [limits] and that the images were baked for this "
                      "engine");
}

std::vector<std::array<std::uint8_t, 32>> SceneEngine::image_hashes() const {
  std::vector<std::array<std::uint8_t, 32>> hashes;
  for (const auto& [file, image] : images_) {
    std::copy_n(image.view().header->content_sha256, 32, hashes.emplace_back().begin());
  }
  return hashes;
}

std::vector<Pose> SceneEngine::start_poses() const {
  std::vector<Pose> poses;
  for (const config::Body& body : config_.bodies) poses.push_back(body.pose);
  return poses;
}

}  // namespace palpate::cli
