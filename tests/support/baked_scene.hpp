// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes baked in memory, an engine over them, and an oracle that shares no code with it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/mesh/check.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::test {

struct FreeDeleter {
  void operator()(void* p) const { std::free(p); }
};

/// 64-byte aligned bytes.
struct AlignedMemory {
  explicit AlignedMemory(std::size_t n)
      : size(n), data(static_cast<std::byte*>(std::aligned_alloc(64, (n + 63) / 64 * 64))) {}
  std::size_t size;
  std::unique_ptr<std::byte, FreeDeleter> data;
  [[nodiscard]] std::span<std::byte> span() const { return {data.get(), size}; }
};

inline bake::BakeOptions options_for(bake::ForEngine engine) {
  bake::BakeOptions options;
  options.engine = engine;
  return options;
}

struct BakedBody {
  explicit BakedBody(bake::Mesh m, bake::ForEngine engine = bake::ForEngine::levels)
      : BakedBody(std::move(m), options_for(engine)) {}
  BakedBody(bake::Mesh m, const bake::BakeOptions& options) : mesh(std::move(m)) {
    bake::BakeReport report;
    const std::vector<std::byte> image = bake::bake(mesh, bake::check(mesh), options, {}, report);
    bytes = std::make_unique<AlignedMemory>(image.size());
    std::memcpy(bytes->data.get(), image.data(), image.size());
    EXPECT_EQ(validate(bytes->span(), view), Status::ok);
  }
  bake::Mesh mesh;
  std::unique_ptr<AlignedMemory> bytes;
  ImageView view;
};

struct BakedScene {
  BakedScene(std::vector<ImageView> bodies_, std::vector<BodyPair> pairs_, const Settings& settings,
             const Limits& limits = {})
      : bodies(std::move(bodies_)),
        pairs(std::move(pairs_)),
        memory(required_bytes(scene(), limits, settings.engine)) {
    EXPECT_EQ(create(scene(), settings, limits, memory.span(), engine), Status::ok);
  }
  [[nodiscard]] Scene scene() const { return {bodies, pairs, 0}; }
  std::vector<ImageView> bodies;
  std::vector<BodyPair> pairs;
  AlignedMemory memory;
  Engine* engine = nullptr;
};

inline TickResult tick_or_fail(Engine& engine, std::span<const Pose> poses,
                               const Budget& budget = {}) {
  TickResult result;
  EXPECT_EQ(tick(engine, poses, budget, result), Status::ok);
  return result;
}

inline Vec3d place(const Pose& pose, const bake::Point& p) {
  return pose.position_m + rotation(pose.orientation) * Vec3d{p[0], p[1], p[2]};
}

/// A quaternion for a rotation vector.
inline Quat turn(Vec3d axis_angle) {
  const double angle = norm(axis_angle);
  const double s = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
  return {std::cos(angle / 2), s * axis_angle.x, s * axis_angle.y, s * axis_angle.z};
}

}  // namespace palpate::test
