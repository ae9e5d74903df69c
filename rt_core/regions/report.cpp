// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/nearby.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

using image::RegionTriangle;
using levels::PairState;

/// Directions of so short a vector are rounding.
constexpr double kTouching = static_cast<double>(kRounding);

Vec3d lane(const float (&rows)[3][kBatch], std::uint32_t i) noexcept {
  return {static_cast<double>(rows[0][i]), static_cast<double>(rows[1][i]),
          static_cast<double>(rows[2][i])};
}

void put(Vec3d p, std::uint32_t corner, std::uint32_t i, float (&rows)[9][kBatch]) noexcept {
  rows[3 * corner][i] = static_cast<float>(p.x);
  rows[3 * corner + 1][i] = static_cast<float>(p.y);
  rows[3 * corner + 2][i] = static_cast<float>(p.z);
}

/// The witness's triangles in the coordinates of a, relative to a corner that is returned: in
/// double up to there, so that only the size of the pair is rounded.
Vec3d place(const PairState& pair, const Witness& witness, std::uint32_t i,
            TriangleLanes& lanes) noexcept {
  const contact::Surface a{pair.image_a, pair.scale_a};
  const contact::Surface b{pair.image_b, pair.scale_b};
  const Vec3d origin = contact::corner(a, witness.a, 0);
  for (std::uint32_t c = 0; c < 3; ++c) {
    put(contact::corner(a, witness.a, c) - origin, c, i, lanes.a);
    const Vec3d of_b = pair.b_in_a.rotation * contact::corner(b, witness.b, c);
    put(of_b + pair.b_in_a.translation - origin, c, i, lanes.b);
  }
  return origin;
}

/// Closest points of a witness, in the coordinates of a.
struct Apart {
  std::uint32_t edge = image::kNone;  ///< MinimaMemory::edges
  Vec3d on_a{};
  Vec3d on_b{};
  Vec3d normal{};  ///< from b to a, outward where a's point is inside b
  double distance = 0;
};

/// In surface_edges, which are listed region by region, each with the first of its triangles.
std::uint32_t convex_edge(const ImageView& image, std::uint32_t triangle,
                          std::uint32_t side) noexcept {
  const image::RegionTriangle& t = image.region_triangles[triangle];
  std::uint32_t name = 3 * triangle + side;
  const std::uint32_t beyond = t.neighbours[side];
  if (beyond == image::kNone) return image::kNone;
  if (beyond < triangle) {
    const image::RegionTriangle& other = image.region_triangles[beyond];
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (other.neighbours[i] == triangle) name = 3 * beyond + i;
    }
  }
  const image::SurfaceRun& run = image.surface_runs[image.region_triangles[name / 3].region];
  const auto edges = image.surface_edges.subspan(run.first_edge, run.edges);
  std::size_t first = 0;
  for (std::size_t count = edges.size(); count > 0;) {
    const std::size_t half = count / 2;
    const bool before = edges[first + half] < name;
    first = before ? first + half + 1 : first;
    count = before ? count - half - 1 : half;
  }
  if (first == edges.size() || edges[first] != name) return image::kNone;
  return run.first_edge + static_cast<std::uint32_t>(first);
}

/// The edge of a on which a pair of closest points lies, where both lie on edges.
std::uint32_t edge_between(const PairState& pair, const Witness& witness,
                           const contact::Foot& foot_of_b) noexcept {
  if (!contact::is_edge(foot_of_b.feature)) return image::kNone;
  const contact::Surface a{pair.image_a, pair.scale_a};
  const contact::Foot foot = contact::closest_point(
      a, witness.a, pair.b_in_a.rotation * foot_of_b.point + pair.b_in_a.translation);
  if (!contact::is_edge(foot.feature)) return image::kNone;
  return convex_edge(*pair.image_a, witness.a, contact::which(foot.feature));
}

/// The sign is that of the pseudonormal where b's point is (Baerentzen and Aanaes 2005), which also
/// is the normal where there is no direction from one point to the other.
/// @param nearest  proved to be: of other points of b the sign tells nothing
Apart apart_of(const PairState& pair, const Witness& witness, Vec3d on_a, Vec3d apart, bool crosses,
               bool nearest) noexcept {
  const contact::Surface b{pair.image_b, pair.scale_b};
  const contact::Foot foot = contact::closest_point(b, witness.b, to_b(pair, on_a));
  const Vec3d pseudonormal = contact::pseudonormal(b, foot);
  const double distance = crosses ? 0 : norm(apart);
  if (distance > kTouching) {
    const bool inside = nearest && dot(apart, pair.b_in_a.rotation * pseudonormal) < 0;
    const double side = inside ? -1 : 1;
    return {inside ? image::kNone : edge_between(pair, witness, foot), on_a, on_a - apart,
            (side / distance) * apart, side * distance};
  }
  const double length = norm(pseudonormal);
  const Vec3d normal =
      length > 0 ? (1 / length) * pseudonormal : contact::face_normal(b, foot.triangle);
  return {image::kNone, on_a, on_a - apart, pair.b_in_a.rotation * normal, distance};
}

class Report {
 public:
  explicit Report(Work& work) noexcept : work_(work) {}

  void run() noexcept {
    std::uint32_t batch[kBatch];
    std::uint32_t pending = 0;
    for (std::uint32_t i = 0; i < work_.count; ++i) {
      if (work_.is_contact(work_.active()[i])) batch[pending++] = i;
      if (pending == kBatch || (i + 1 == work_.count && pending > 0)) {
        report_batch(batch, pending);
        pending = 0;
      }
    }
  }

 private:
  void report_batch(const std::uint32_t (&batch)[kBatch], std::uint32_t count) noexcept {
    Vec3d origin[kBatch];
    TriangleLanes& lanes = work_.memory.search->kernel.lanes;
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Active& item = work_.active()[batch[i < count ? i : 0]];
      origin[i] = place(work_.pair_of(item), work_.witness_of(item), i, lanes);
    }
    WitnessLanes found;
    work_.memory.kernels->witnesses(work_.memory.search->kernel, found);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Active& item = work_.active()[batch[i]];
      add(item,
          apart_of(work_.pair_of(item), work_.witness_of(item), origin[i] + lane(found.on_a, i),
                   lane(found.apart, i), (found.crossing >> i & 1u) != 0, !(item.width > kClosed)));
    }
  }

  void add(const Active& item, const Apart& found) noexcept {
    const PairState& pair = work_.pair_of(item);
    const Witness& witness = work_.witness_of(item);
    MinimaResult& result = work_.result;
    if (result.contacts == work_.memory.contacts.size()) {
      result.truncated_by_memory = true;
      return;
    }
    const auto world = [&](Vec3d p) {
      return pair.centre_a_m + pair.rotation_a * (pair.unit_m * p);
    };
    work_.memory.edges[result.contacts] = found.edge;
    Contact& out = work_.memory.contacts[result.contacts++];
    out = {};
    out.point_a_m = world(found.on_a);
    out.point_b_m = world(found.on_b);
    out.centre_m = 0.5 * (out.point_a_m + out.point_b_m);
    out.normal = pair.rotation_a * found.normal;
    out.distance_m = found.distance * pair.unit_m;
    out.pair = item.pair;
    out.piece_a = pair.image_a->region_triangles[witness.a].piece;
    out.piece_b = pair.image_b->region_triangles[witness.b].piece;
    if (out.distance_m < result.min_distance_m) result.min_distance_m = out.distance_m;
  }

  Work& work_;
};

}  // namespace

void report(Work& work) noexcept { Report(work).run(); }

}  // namespace palpate::regions
