// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file's struct to an engine that is ready to tick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "config/scene.hpp"
#include "rt_core/palpate_rt.hpp"
#include "tools/palpate/image_file.hpp"

namespace palpate::cli {

/// Opens the images of a scene, each file once however many bodies show it, and makes the
/// engine. Owns all memory.
class SceneEngine {
 public:
  /// @param scene  must outlive this
  /// Throws Failure: kUsage where this build or the engine cannot serve the scene's settings,
  /// kRefused where an image is refused or images and engine together need more memory than the
  /// scene allows.
  explicit SceneEngine(const config::Scene& scene);

  [[nodiscard]] Engine& engine() { return *engine_; }

  /// A new engine on the same memory, as if nothing had ever ticked.
  void restart();

  /// Makes twice the room in a new engine. False, and nothing changed, where that is more than the
  /// scene's max_memory_MB or than an engine can use.
  [[nodiscard]] bool grow();

  /// [bodies] where the scene puts them.
  [[nodiscard]] std::vector<Pose> start_poses() const;

  /// [bodies] lives as long as this.
  [[nodiscard]] std::span<const ImageView> images() const { return bodies_; }

  /// content_sha256 of the scene's images.
  [[nodiscard]] std::vector<std::array<std::uint8_t, 32>> image_hashes() const;

  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] std::size_t image_bytes() const { return image_bytes_; }
  [[nodiscard]] std::size_t engine_bytes() const { return engine_bytes_; }

 private:
  [[nodiscard]] bool fits(std::uintmax_t bytes) const;
  void require_memory(std::uintmax_t bytes) const;
  void open_images();
  void allocate(std::size_t bytes);

  struct Free {
    void operator()(std::byte* memory) const {
      ::operator delete[](memory, std::align_val_t(image::kAlignment));
    }
  };

  const config::Scene& config_;
  Limits limits_;  // the scene's, until grow()
  std::map<std::filesystem::path, ImageFile> images_;
  std::vector<ImageView> bodies_;
  Scene scene_;
  std::size_t image_bytes_ = 0, engine_bytes_ = 0;
  std::unique_ptr<std::byte[], Free> memory_;
  Engine* engine_ = nullptr;
};

}  // namespace palpate::cli
