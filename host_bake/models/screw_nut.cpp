// SPDX-License-Identifier: GPL-3.0-or-later
// A screw and its nut, screwed on. On the nut's part of the thread both share their rows, and there
// the nut is the screw enlarged across z: triangulated alike, the two cannot touch. Millimetres
// inside.
#include <algorithm>
#include <array>
#include <cmath>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/loft.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/shapes.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

constexpr double kThreadRoot_mm = 3.0;
constexpr double kDepth_mm = 1.0;
constexpr double kPitch_mm = 2.0;
constexpr double kTip_mm = -12.0;  // z of the screw's end; its head stands on z = 0
constexpr double kHead_mm = 4.0;
constexpr double kHeadRadius_mm = 6.5;
constexpr double kKnurl_mm = 0.25;
constexpr double kKnurls = 24.0;
constexpr double kSocketRadius_mm = 2.6;
constexpr double kSocketDepth_mm = 2.0;

constexpr double kThreadGap = 0.036;  // of the radius at each place of the thread
constexpr double kNutBottom_mm = -9.5, kNutTop_mm = -3.5;
constexpr double kNutFace_mm = 0.5;  // the faces lie beyond the threaded part by this
constexpr double kCountersink_mm = 4.7;
constexpr double kFlat_mm = 6.5;  // half the width across the flats
constexpr double kEdge_mm = 0.6;

// Shares of the vertices.
constexpr double kMatedShare = 0.45;
constexpr double kTipShare = 0.17;

/// Where the surface is at (u, v): distance from z, and z.
struct Place {
  double radius_mm, z_mm;
};

double hexagon_mm(double flat_mm, double turns) {
  const double corner = turns * 6.0 - std::floor(turns * 6.0) - 0.5;
  return std::min(flat_mm / cos_turns(corner / 6.0), 1.12 * flat_mm);
}

/// Flanks at 30 degrees from the plane across, crest and root rounded.
double thread_mm(double turns, double z_mm) {
  const double phase = z_mm / kPitch_mm - turns;
  const double ramp = std::abs(2.0 * (phase - std::floor(phase)) - 1.0);
  const double height = smooth_min(smooth_max((ramp - 0.2) / 0.6, 0.0, 0.2), 1.0, 0.2);
  const double whole =
      smooth_step(kTip_mm - 0.2, kTip_mm + 1.8, z_mm) * (1.0 - smooth_step(-2.2, -0.2, z_mm));
  return kThreadRoot_mm + kDepth_mm * whole * height;
}

/// v in [0, 1] end face, [1, 2] shank, [2, 3] below the head, [3, 4] around it, [4, 5] top.
Place screw_place(double turns, double v) {
  if (v <= 1.0) return {v * thread_mm(turns, kTip_mm), kTip_mm};
  if (v <= 2.0) {
    const double z_mm = kTip_mm * (2.0 - v);
    return {thread_mm(turns, z_mm), z_mm};
  }
  const double edge = kHeadRadius_mm - kEdge_mm;
  if (v <= 3.0) return {mix(thread_mm(turns, 0.0), edge, v - 2.0), 0.0};
  if (v <= 4.0) {
    const double height = v - 3.0;
    const double round = round_end(height / 0.2) * round_end((1.0 - height) / 0.2);
    const double knurl_mm = kKnurl_mm * cos_turns(kKnurls * turns);
    return {edge + round * (kEdge_mm + knurl_mm), kHead_mm * height};
  }
  const double radius_mm = edge * (5.0 - v);
  const double socket = hexagon_mm(kSocketRadius_mm, turns);
  const double inside = 1.0 - smooth_step(socket - 0.6, socket + 0.2, radius_mm);
  return {radius_mm, kHead_mm - kSocketDepth_mm * inside};
}

constexpr double v_at(double z_mm) { return 2.0 - z_mm / kTip_mm; }

constexpr double kMatedStart = v_at(kNutBottom_mm);
constexpr double kMatedEnd = v_at(kNutTop_mm);

/// Up to kMatedEnd the thread, then seven straight pieces over the outside; the last one ends short
/// of the thread.
constexpr double kNutPieces = 6.8;

Place nut_place(double turns, double v) {
  if (v <= kMatedEnd) {
    const Place screw = screw_place(turns, v);
    return {(1.0 + kThreadGap) * screw.radius_mm, screw.z_mm};
  }
  const double hexagon = hexagon_mm(kFlat_mm, turns);
  const double top = kNutTop_mm + kNutFace_mm;
  const double bottom = kNutBottom_mm - kNutFace_mm;
  const std::array<Place, 8> outline{
      {{(1.0 + kThreadGap) * thread_mm(turns, kNutTop_mm), kNutTop_mm},
       {kCountersink_mm, top},
       {hexagon - kEdge_mm, top},
       {hexagon, top - kEdge_mm},
       {hexagon, bottom + kEdge_mm},
       {hexagon - kEdge_mm, bottom},
       {kCountersink_mm, bottom},
       {(1.0 + kThreadGap) * thread_mm(turns, kNutBottom_mm), kNutBottom_mm}}};
  const double piece = std::min(v - kMatedEnd, kNutPieces);
  const auto i = static_cast<std::size_t>(piece);
  const double share = piece - static_cast<double>(i);
  return {mix(outline[i].radius_mm, outline[i + 1].radius_mm, share),
          mix(outline[i].z_mm, outline[i + 1].z_mm, share)};
}

using Profile = Place (*)(double turns, double v);

Surface turned(Profile profile, std::uint64_t seed) {
  const double start = Random(seed).signed_unit();
  return [=](double v) -> Curve {
    return [=](double u) {
      const Place p = profile(u, v);
      return Point{0.001 * p.radius_mm * cos_turns(u + start),
                   0.001 * p.radius_mm * sin_turns(u + start), 0.001 * p.z_mm};
    };
  };
}

std::size_t share_of(std::size_t triangles, double share) {
  const std::size_t vertices = triangles / 2;
  return static_cast<std::size_t>(share * static_cast<double>(vertices));
}

std::vector<Row> mated_rows(std::size_t triangles) {
  return plan_rows(turned(screw_place, 0), kMatedStart, kMatedEnd, share_of(triangles, kMatedShare),
                   Last::ring);
}

}  // namespace

Mesh screw(std::size_t triangles, std::uint64_t seed) {
  const Surface surface = turned(screw_place, seed);
  const std::size_t tip = share_of(triangles, kTipShare);
  const std::size_t rest = triangles / 2 + 1 - tip - share_of(triangles, kMatedShare);
  std::vector<Row> rows{{0.0, 1, 0.0}};
  append(rows, plan_rows(surface, 0.0, kMatedStart, tip, Last::ring));
  append(rows, mated_rows(triangles));
  append(rows, plan_rows(surface, kMatedEnd, 5.0, rest, Last::pole));
  return loft(surface, rows, Ends::poles);
}

Mesh nut(std::size_t triangles, std::uint64_t seed) {
  const Surface surface = turned(nut_place, seed);
  const std::size_t rest = triangles / 2 - share_of(triangles, kMatedShare);
  std::vector<Row> rows = mated_rows(triangles);
  append(rows, plan_rows(surface, kMatedEnd, kMatedEnd + kNutPieces, rest, Last::ring));
  return loft(surface, rows, Ends::joined);
}

}  // namespace palpate::bake
