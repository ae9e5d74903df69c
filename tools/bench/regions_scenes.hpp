// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of two detailed objects and their motions, for bench_regions.
#pragma once

#include <memory>
#include <new>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/pack/aligned.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::bench {

/// How the tool moves.
enum class Motion {
  sliding,  ///< over the other body, at 0.4 delta
  tips,     ///< turned upside down upon the other body, at 0.4 delta: teeth meet teeth
  pressed   ///< where it was modelled, in a small clearance, until 0.1 delta is left
};

struct SceneName {
  const char* name;
  const char* a;
  const char* b;
  Motion motion;
};
inline constexpr SceneName kScenes[] = {
    {"jaws", "jaw_lower", "jaw_upper", Motion::pressed},
    {"tips", "jaw_lower", "jaw_lower", Motion::tips},
    {"golf", "golf_ball", "golf_ball", Motion::sliding},
    {"socket", "golf_ball", "golf_shell", Motion::pressed},
    {"screw", "screw", "nut", Motion::pressed},
    {"joint", "ball_joint_head", "ball_joint_cup", Motion::pressed}};

/// A model, and its image with regions for a tolerance.
struct Body {
  Body(const char* model, double delta_rel);
  bake::Mesh mesh;
  std::unique_ptr<bake::AlignedCopy> image;
  ImageView view;
};

/// An engine over two bodies, tool first, that can forget all it knows.
class Bench {
 public:
  Bench(const Body& a, const Body& b, double delta_m);
  void forget();
  /// Of all regions: what clusters make of them is the force stage's affair, and neighbours whose
  /// nearest point is a common one join a cluster or not by the last bit.
  [[nodiscard]] Vec3d summed_force(const TickResult& r) const;
  /// @param budget_us  of the thread's processor time; 0: none
  TickResult tick_at(const Pose& pose, double budget_us = 0);

 private:
  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  [[nodiscard]] Scene scene() const { return {views_, pairs_, 0}; }

  std::vector<ImageView> views_;
  std::vector<BodyPair> pairs_{{0, 1}};
  Settings settings_;
  std::size_t bytes_ = 0;
  std::unique_ptr<std::byte[], Free> memory_;
  Engine* engine_ = nullptr;
};

/// The thread's own processor time: a busy machine shows in the caches only.
std::uint64_t processor_ns(void* = nullptr);

/// Poses of the tool; the other body lies at the origin.
std::vector<Pose> poses_of(const SceneName& scene, const Body& a, const Body& b, double delta,
                           int ticks);

}  // namespace palpate::bench
