// SPDX-License-Identifier: GPL-3.0-or-later
// Two jaws: a U-shaped band, the biting surface over it, a base below. Over every section of the
// band both surfaces are graphs, so a jaw cannot cross itself; and jaws of equal triangle counts
// have their vertices at the same places of the band, so they cannot cross each other, however few
// triangles they have. Millimetres inside.
#include <algorithm>
#include <array>
#include <cmath>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/jaw_profile.hpp"
#include "host_bake/models/loft.hpp"
#include "host_bake/models/shapes.hpp"
#include "host_bake/models/spine.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

constexpr double kFrontToOrigin_mm = 24.0;
constexpr double kTurn = 84.0 / 360.0;  // of the arch, from the midline to its end
constexpr double kRimHeight_mm = 13.5;  // of the band's edge, off the bite
constexpr double kBase_mm = 3.5;        // the base beyond the edge
constexpr double kBitingShare = 0.72;   // of a section's vertices

/// Heights over a section shrink to the edge's at the sides and at the ends of the band.
double edge_share(double x) { return std::sqrt(std::max(0.0, 1.0 - fourth(x))); }

/// Direction of the arch, going from the right end (s = 0) round the front to the left end.
double arch_heading_turns(double s_mm) {
  const double x = s_mm / kArchHalf_mm - 1.0;
  const double x2 = x * x;
  // Most of the turn in front; the derivative is zero to the third order at the ends.
  return -kTurn * x * (35.0 - 35.0 * x2 + 21.0 * x2 * x2 - 5.0 * x2 * x2 * x2) / 16.0;
}

double rim_z(Jaw jaw) { return jaw == Jaw::lower ? -kRimHeight_mm : kRimHeight_mm; }

/// The biting surface, brought down to the band's edge; `across` in [-1, 1] of the half width.
double closed_z(Jaw jaw, double s_mm, double across, std::uint64_t seed) {
  const double end_share = edge_share(s_mm / kArchHalf_mm);
  if (end_share <= 0.0) return rim_z(jaw);
  const double t_mm = kBandHalf_mm * end_share * across;
  const double biting = biting_z_mm(jaw, {s_mm, t_mm}, seed);
  return mix(rim_z(jaw), biting, end_share * edge_share(across));
}

/// Where the vertices of a section lie across the band: in even steps along the mean profile of
/// both jaws, the same for every section and for both jaws.
class Across {
 public:
  explicit Across(std::uint64_t seed) {
    constexpr int kSections = 60;
    for (int k = 0; k < kSections; ++k) {
      add_section(kArchHalf_mm * 0.9 * (2.0 * k / (kSections - 1.0) - 1.0), seed);
    }
    for (std::size_t i = 1; i < kSamples; ++i) length_[i] += length_[i - 1];
  }

  /// `share` in [0, 1] of the profile's length to [-1, 1] of the half width.
  [[nodiscard]] double at(double share) const {
    const double length = share * length_.back();
    const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, length);
    const auto i = static_cast<std::size_t>(above - length_.begin()) - 1;
    const double part = (length - length_[i]) / (length_[i + 1] - length_[i]);
    return mix(sample(i), sample(i + 1), part);
  }

 private:
  static constexpr std::size_t kSamples = 129;

  static double sample(std::size_t i) {
    return 2.0 * static_cast<double>(i) / (kSamples - 1) - 1.0;
  }

  void add_section(double s_mm, std::uint64_t seed) {
    double lower_before = rim_z(Jaw::lower);
    double upper_before = rim_z(Jaw::upper);
    for (std::size_t i = 1; i < kSamples; ++i) {
      const double lower = closed_z(Jaw::lower, s_mm, sample(i), seed);
      const double upper = closed_z(Jaw::upper, s_mm, sample(i), seed);
      length_[i] += std::sqrt(square(2.0 * kBandHalf_mm / (kSamples - 1)) +
                              square(lower - lower_before) + square(upper - upper_before));
      lower_before = lower;
      upper_before = upper;
    }
  }

  std::array<double, kSamples> length_{};  // from one edge of the band to each sample
};

/// Offset across the band and height.
struct SectionPoint {
  double t_mm, z_mm;
};

/// Vertex u of a section: in [0, kBitingShare] on the biting surface outwards, then on the base
/// back.
SectionPoint section_point(Jaw jaw, double s_mm, double u, const Across& places,
                           std::uint64_t seed) {
  u -= std::floor(u);
  const double end_share = edge_share(s_mm / kArchHalf_mm);
  const double half_width_mm = kBandHalf_mm * end_share;
  if (u < kBitingShare) {
    const double across = places.at(u / kBitingShare);
    return {half_width_mm * across, closed_z(jaw, s_mm, across, seed)};
  }
  // As on an ellipse: denser towards the edges, where the base turns upright.
  const double across = cos_turns(0.5 * (u - kBitingShare) / (1.0 - kBitingShare));
  const double depth = 1.0 + kBase_mm / kRimHeight_mm * end_share * edge_share(across);
  return {half_width_mm * across, rim_z(jaw) * depth};
}

Mesh jaw(Jaw which, std::size_t triangles, std::uint64_t seed) {
  const Spine arch(arch_heading_turns, 2.0 * kArchHalf_mm);
  const SpinePoint front = arch.at(kArchHalf_mm);
  const Across places(seed);
  const auto surface_of = [&](Jaw side) -> Surface {
    return [&, side](double s_mm) -> Curve {
      return [&, side, s_mm, at = arch.at(s_mm)](double u) {
        const SectionPoint p = section_point(side, s_mm - kArchHalf_mm, u, places, seed);
        return Point{0.001 * (at.x - front.x - at.ty * p.t_mm),
                     0.001 * (at.y - front.y + at.tx * p.t_mm + kFrontToOrigin_mm), 0.001 * p.z_mm};
      };
    };
  };
  // Always the lower jaw's rows.
  const std::vector<Row> rows =
      plan_body(surface_of(Jaw::lower), 0.0, 2.0 * kArchHalf_mm, triangles / 2 + 2);
  return loft(surface_of(which), rows, Ends::poles);
}

}  // namespace

Mesh jaw_lower(std::size_t triangles, std::uint64_t seed) {
  return jaw(Jaw::lower, triangles, seed);
}

Mesh jaw_upper(std::size_t triangles, std::uint64_t seed) {
  return jaw(Jaw::upper, triangles, seed);
}

}  // namespace palpate::bake
