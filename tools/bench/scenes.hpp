// SPDX-License-Identifier: GPL-3.0-or-later
// Two detailed objects and a motion of one about the other, for the benchmarks of both engines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/pack/aligned.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/kernels.hpp"

namespace palpate::bench {

struct SceneName {
  const char* name;
  const char* a;
  const char* b;
  bool interlock;            ///< as modelled they interlock with a small clearance
  bool upside_down = false;  ///< a is turned by half a turn: tips of teeth meet tips
};

/// A model of `palpate make-model`, as it is made; gear_60 or gear_50, spur gears of so many teeth
/// in needles; or, where the name has a dot, a mesh file.
bake::Mesh mesh_of(std::string_view model, std::size_t triangles = 0);

/// A model, baked in memory.
struct Body {
  /// @param triangles      0: the model's default
  /// @param max_deviation  detail left out, relative to the radius
  Body(const char* model, double delta_rel, bake::ForEngine engine, std::size_t triangles = 0,
       double max_deviation = 0);
  Body(const bake::Mesh& mesh, double delta_rel, bake::ForEngine engine, double max_deviation = 0);
  std::unique_ptr<bake::AlignedCopy> image;
  ImageView view;
};

Vec3d centre_of(const Body& body);

/// An engine over two bodies that can forget all it knows.
class Bench {
 public:
  /// With room for more than any scene needs.
  Bench(const Body& a, const Body& b, const Settings& settings);
  Bench(const Body& a, const Body& b, const Settings& settings, const Limits& limits);
  void forget();
  /// Regions engine: not the widest instructions of this processor.
  void use(const regions::Kernels& kernels);
  /// b stays at its origin.
  TickResult tick_at(const Pose& pose, const Budget& budget = {});
  [[nodiscard]] const Settings& settings() const { return settings_; }
  /// All that the engine knows from earlier ticks.
  void save(std::vector<std::byte>& state) const;
  void restore(const std::vector<std::byte>& state);

 private:
  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  [[nodiscard]] Scene scene() const { return {views_, pairs_, 0}; }

  std::vector<ImageView> views_;
  std::vector<BodyPair> pairs_{{0, 1}};
  Settings settings_;
  Limits limits_;
  const regions::Kernels* kernels_ = nullptr;  ///< null: the widest
  std::size_t bytes_ = 0;
  std::unique_ptr<std::byte[], Free> memory_;
  Engine* engine_ = nullptr;
};

/// Poses of a, found with the region engine. Interlocking bodies: small turns where they lie,
/// pressed in a turning direction until about 0.1 delta is left. Others: slides over the other body
/// at a distance of about 0.4 delta.
std::vector<Pose> motion(const SceneName& scene, const Body& a, const Body& b, double delta_m,
                         int ticks);

/// The least distance there, or `most`.
/// @param wide  an exact engine whose delta is no less than `most`
double distance_at(Bench& wide, const Pose& pose, double most);

/// Moves against `out`, a unit vector, until `gap_m` is left.
Pose brought_near(Bench& wide, Pose pose, Vec3d out, double gap_m, double reach_m);

/// Root mean square of the differences over that of their largest truth, from tick `first` on.
double nrmse(const std::vector<Vec3d>& forces, const std::vector<Vec3d>& truth, std::size_t first);

double mean(const std::vector<double>& values);

/// The value that this share of them are no larger than; 0 where there are none.
double percentile(std::vector<double> values, double share);

}  // namespace palpate::bench
