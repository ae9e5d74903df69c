// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/depths.hpp"

#include "rt_core/geometry/directions.hpp"

namespace palpate::force {
namespace {

constexpr double kSameCosine = 1 - 1e-12;  // a microradian apart

/// Where the tangents touch, behind the rim of a cell's cone: 10 and 30 degrees.
struct Angle {
  double cosine;
  double sine;
};
constexpr Angle kTouch[DeepCells::kTangents] = {{0.98480775301220802, 0.17364817766693036},
                                                {0.86602540378443865, 0.5}};
/// Bounds are taken in float.
constexpr float kRoundingUp = 1 + 1e-5f;

/// What every 64-bit target computes at once, in the same bits as one by one.
using Two = double __attribute__((vector_size(2 * sizeof(double))));
using Four = float __attribute__((vector_size(4 * sizeof(float))));
constexpr std::uint32_t kTwo = 2;
constexpr std::uint32_t kFour = 4;
static_assert(DeepCells::kCells % kFour == 0);

template <class Vector, class Real>
Vector load(const Real* from) noexcept {
  Vector v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

using Mask = decltype(Four{} > Four{});

bool any(Mask mask) noexcept {
  std::uint64_t halves[kTwo];
  __builtin_memcpy(halves, &mask, sizeof mask);
  return (halves[0] | halves[1]) != 0;
}

double magnitude(double v) noexcept { return v < 0 ? -v : v; }

std::uint32_t quarter_of(Vec3d n) noexcept {
  const double x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
  const std::uint32_t largest = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  return 8 * largest + (n.x < 0 ? 4u : 0u) + (n.y < 0 ? 2u : 0u) + (n.z < 0 ? 1u : 0u);
}

/// Largest depth times kinship of a direction with those side by side, and `most_m`.
double most_of(const DeepLanes& lanes, Vec3d n, double most_m) noexcept {
  Two most{};
  for (std::uint32_t i = 0; i < DeepLanes::kLanes; i += kTwo) {
    const Two cosine =
        n.x * load<Two>(lanes.x + i) + n.y * load<Two>(lanes.y + i) + n.z * load<Two>(lanes.z + i);
    const Two here_m = kinship(cosine > 0.0 ? cosine : Two{}) * load<Two>(lanes.depth_m + i);
    most = here_m > most ? here_m : most;
  }
  most_m = most[0] > most_m ? most[0] : most_m;
  return most[1] > most_m ? most[1] : most_m;
}

/// Largest depth times kinship that four cells may have with a direction.
Four most_of(const DeepCells& cells, std::uint32_t first, Vec3f n) noexcept {
  const Four cosine = n.x * load<Four>(cells.axis[0] + first) +
                      n.y * load<Four>(cells.axis[1] + first) +
                      n.z * load<Four>(cells.axis[2] + first);
  Four nearest = Four{} + 1.0f;
  for (std::uint32_t k = 0; k < DeepCells::kTangents; ++k) {
    const Four tangent =
        cosine * load<Four>(cells.slope[k] + first) + load<Four>(cells.rise[k] + first);
    nearest = tangent < nearest ? tangent : nearest;
  }
  nearest = nearest > 0.0f ? nearest : Four{};
  return (0.5f * kRoundingUp) * nearest * nearest * (1.0f + nearest) *
         load<Four>(cells.depth_m + first);
}

/// Directions of one cell.
struct Cone {
  Vec3d axis{};
  double cosine = 1;  // of the angle between the axis and the farthest of them
  std::uint32_t count = 0;
  std::uint32_t end = 0;   // in ranking
  std::uint32_t cell = 0;  // in DeepCells
};

/// Contacts of each cell one after the other.
/// @return how many cells are not empty
std::uint32_t sort(std::span<Felt> felt, std::span<Ranked> ranking,
                   Cone (&cones)[DeepCells::kCells]) noexcept {
  for (Felt& f : felt) {
    f.cell = quarter_of(f.direction);
    cones[f.cell].axis += f.direction;
    ++cones[f.cell].count;
  }
  std::uint32_t cells = 0;
  std::uint32_t first = 0;
  for (Cone& cone : cones) {
    if (cone.count == 0) continue;
    cone.axis = (1 / norm(cone.axis)) * cone.axis;
    cone.cell = cells++;
    cone.end = first;
    first += cone.count;
  }
  for (std::uint32_t i = 0; i < felt.size(); ++i) {
    Cone& cone = cones[felt[i].cell];
    const double cosine = dot(cone.axis, felt[i].direction);
    cone.cosine = cosine < cone.cosine ? cosine : cone.cosine;
    ranking[cone.end++] = {felt[i].depth_m, i};
    felt[i].cell = cone.cell;
  }
  return cells;
}

/// A direction at an angle t from the axis is no nearer to any of a cell than t less the rim's
/// angle r. The cosine of that is a concave function of cos t: no tangent is anywhere below it.
void bound(const Cone& cone, DeepCells& cells) noexcept {
  const std::uint32_t i = cone.cell;
  cells.axis[0][i] = static_cast<float>(cone.axis.x);
  cells.axis[1][i] = static_cast<float>(cone.axis.y);
  cells.axis[2][i] = static_cast<float>(cone.axis.z);
  cells.depth_m[i] = static_cast<float>(cells.cells[i].waiting.top().depth_m);
  const double sine2 = 1 - cone.cosine * cone.cosine;
  const double sine = sqrt_of(sine2 > 0 ? sine2 : 0);
  for (std::uint32_t k = 0; k < DeepCells::kTangents; ++k) {
    const Angle& behind = kTouch[k];
    const double at = cone.cosine * behind.cosine - sine * behind.sine;
    const double slope = behind.sine / (sine * behind.cosine + cone.cosine * behind.sine);
    cells.slope[k][i] = static_cast<float>(slope);
    cells.rise[k][i] = static_cast<float>(behind.cosine - at * slope);
  }
}

}  // namespace

Depths::Depths(std::span<Felt> felt, std::span<Ranked> ranking, DeepCells& cells) noexcept
    : felt_(felt), cells_(cells) {
  Cone cones[DeepCells::kCells];
  count_ = sort(felt, ranking, cones);
  for (float& depth : cells_.depth_m) depth = 0;
  for (const Cone& cone : cones) {
    if (cone.count == 0) continue;
    DeepCells::Cell& cell = cells_.cells[cone.cell];
    cell = {};
    cell.waiting = MinQueue<Ranked, Deeper>(ranking.subspan(cone.end - cone.count, cone.count));
    cell.waiting.fill();
    bound(cone, cells_);
  }
}

double Depths::around(const Felt& f) noexcept {
  double most_m = look_at(f.cell, f.direction, f.depth_m);
  const Vec3f n = vec_cast<float>(f.direction);
  for (std::uint32_t first = 0; first < count_; first += kFour) {
    const Four bound_m = most_of(cells_, first, n);
    if (!any(bound_m > static_cast<float>(most_m))) continue;
    for (std::uint32_t k = 0; k < kFour; ++k) {
      if (static_cast<double>(bound_m[k]) <= most_m || first + k == f.cell) continue;
      most_m = look_at(first + k, f.direction, most_m);
    }
  }
  return most_m;
}

double Depths::look_at(std::uint32_t cell, Vec3d direction, double most_m) noexcept {
  DeepCells::Cell& of = cells_.cells[cell];
  DeepLanes* lanes = cells_.lanes[cell];
  for (std::uint32_t i = 0; i < DeepCells::kMostLooks; i += DeepLanes::kLanes, ++lanes) {
    if (i == of.count) lay(of, *lanes);
    if (i >= of.count || lanes->depth_m[0] <= most_m) break;
    most_m = most_of(*lanes, direction, most_m);
  }
  return most_m;
}

/// The deepest that wait, as many as are looked at at once.
void Depths::lay(DeepCells::Cell& of, DeepLanes& to) noexcept {
  for (std::uint32_t lane = 0; lane < DeepLanes::kLanes && !of.waiting.empty(); of.waiting.pop()) {
    const Felt& next = felt_[of.waiting.top().felt];
    // It has nothing to say that the deeper one has not, and would use up looks.
    if (of.count > 0 && dot(of.last, next.direction) >= kSameCosine) continue;
    of.last = next.direction;
    if (lane == 0) to = {};
    to.x[lane] = of.last.x;
    to.y[lane] = of.last.y;
    to.z[lane] = of.last.z;
    to.depth_m[lane] = next.depth_m;
    ++lane;
    ++of.count;
  }
}

}  // namespace palpate::force
