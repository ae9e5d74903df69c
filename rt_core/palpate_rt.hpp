// SPDX-License-Identifier: Apache-2.0
// The contact engine: poses in, wrench, contacts and certificate out, inside a budget, on memory
// that the caller hands over once.
//
// Source: Otaduy and Lin, Sensation Preserving Simplification for Haptic Rendering, SIGGRAPH 2003,
// Sec. 5 and Appendix B. Departures are stated at the declarations; docs/DESIGN.md gives the
// reasons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "rt_core/base/status.hpp"
#include "rt_core/geometry/matrix6.hpp"
#include "rt_core/geometry/pose.hpp"
#include "rt_core/image/view.hpp"

namespace palpate {

inline constexpr std::uint32_t kMaxBodies = 64;
inline constexpr std::uint32_t kMaxPairs = 256;

/// Two bodies that may touch, by index into the scene's bodies. Normals point from b to a.
struct BodyPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// What the engine works on. All spans and images must outlive the engine.
struct Scene {
  std::span<const ImageView>
      bodies;  ///< 1 to kMaxBodies validated images; one image may appear more than once
  std::span<const BodyPair> pairs;  ///< 1 to kMaxPairs
  std::uint32_t tool = 0;           ///< the body that the device holds: the wrench is the one on it
};

/// The contact query.
enum class EngineKind : std::uint8_t {
  levels,   ///< the paper's: convex pieces, simplified where it cannot be felt
  regions,  ///< the least push on contacts of both original surfaces (docs/CONTACT.md), with
            ///< certified distances of regions of a from b
};

/// What bounds the original surface below a pair of pieces (levels engine).
enum class Bounds : std::uint8_t {
  tight,  ///< culling hulls and their residuals
  paper,  ///< the pieces' own hulls, widened by h (eq. 5)
};

/// What is refined first while the budget lasts (levels engine).
enum class Order : std::uint8_t {
  deviation,  ///< the largest weighted surface deviation s* (the paper's time-critical mode)
  force,      ///< what can still change the force most: the widest interval from what is proved of
              ///< a distance up to the contact known there, or to delta
};

/// How contacts are found and turned into forces.
struct Settings {
  EngineKind engine = EngineKind::levels;  ///< fixed when the engine is made
  double delta_m =
      0.0005;         ///< contact tolerance delta: features nearer than this are contacts; > 0
  double s0 = 0.025;  ///< threshold of eq. 7, relative to the radius of the body that loses the
                      ///< detail; >= 0
  /// Surface deviation allowed, relative to delta: pieces with s > kappa * delta are refined,
  /// whatever s0 says; this bounds the error of force. >= 0; infinity: no such rule.
  double kappa = std::numeric_limits<double>::infinity();
  /// Prove the wrench of the original surfaces (images without surface sections: of their pieces).
  /// Levels engine: report every pair below delta, whatever s0 says. Regions engine: the least
  /// distance of every region below delta.
  bool exact = false;
  Bounds bounds = Bounds::tight;
  /// Without a budget it changes nothing.
  Order order = Order::force;

  /// Regions engine: a tick that is not exact goes on until the certified error of the force is no
  /// more; 0: until nothing that is likely to change it is left, and what is cheap to prove is
  /// proved. Whether two bodies touch is decided all the same, as far as a budget goes.
  double force_tolerance_N = 0;
  /// Of the force in any one direction, >= 0. With 0, exact queries give distances alone.
  double stiffness_N_per_m = 600.0;
  /// Contacts nearer together than this count as one where the force is shared out (Places); it
  /// acts on the torque alone. >= 0; 0: every contact counts.
  double cluster_radius_m = 0.003;
  double max_force_N = std::numeric_limits<double>::infinity();    ///< the wrench's force is scaled
                                                                   ///< down to this length
  double max_torque_Nm = std::numeric_limits<double>::infinity();  ///< the wrench's torque is
                                                                   ///< scaled down to this length
};

/// Capacities; more memory, never more time.
struct Limits {
  std::uint32_t nodes = 1u << 17;     ///< nodes of the bounding volume test tree over all pairs
  std::uint32_t contacts = 1u << 14;  ///< contacts of one tick over all pairs (regions engine: no
                                      ///< more than 64 for each vertex and each convex edge take
                                      ///< memory)
  std::uint32_t clusters = 1u << 12;  ///< grid points of cluster_radius_m near contacts of one tick
};

/// What one tick may spend. Refinement ends at whichever limit is met first; the answer is valid
/// all the same.
struct Budget {
  std::uint64_t units = std::numeric_limits<std::uint64_t>::max();  ///< see TickResult::queries
  std::uint64_t (*clock_ns)(void* context) = nullptr;  ///< a monotonic clock, or null: units only
  void* clock_context = nullptr;
  std::uint64_t deadline_ns =
      0;  ///< refinement stops at clock_ns() >= deadline_ns; ignored without a clock
  /// So many units more, and so much later (ns), for a tick of the regions engine that by then
  /// feels nothing of two bodies and cannot rule out that they touch: for that question alone,
  /// until it is answered. The largest numbers: however long it takes, so that no tick in contact
  /// reports none. Each adds to a limit of its kind, where there is one. A tick of the levels
  /// engine has no use for it: where its budget ends, simplified pieces are its contacts.
  std::uint64_t reserve_units = 0;
  std::uint64_t reserve_ns = 0;
};

/// Two points of the bodies that are nearer than delta, or overlap. World axes.
///
/// Where they overlap, the levels engine gives points of the pieces' hulls or, where a second way
/// out counts, points between those of the two ways: they need not lie on a surface. Of contacts of
/// surfaces, which carry the force there, and of the regions engine they are a vertex of one body
/// and its foot on the other, or two points of edges.
struct Contact {
  Vec3d point_a_m{};  ///< on the surface of body a
  Vec3d point_b_m{};  ///< on the surface of body b
  /// Where its force acts: midway between the two points or, where wide pieces meet at their faces
  /// (levels engine), beside that, at the centre of pressure (convex/pressure.hpp).
  Vec3d centre_m{};
  /// Unit, from b to a; of an overlap the way that parts the surfaces. Regions engine: of the
  /// normals that the surface has there, the nearest to that.
  Vec3d normal{};
  double distance_m = 0;  ///< of the points; signed: negative where the pieces overlap
  /// 0 to 1: how far the surfaces face each other there (docs/CONTACT.md, w). Of
  /// pieces (levels engine) 1.
  double share = 1;
  /// Its force on the tool is weight * stiffness * (delta - distance) along the normal.
  double weight = 0;
  std::uint32_t pair = 0;
  std::uint32_t piece_a = 0, level_a = 0;
  std::uint32_t piece_b = 0, level_b = 0;
};

/// What a tick knows of whether anything is nearer than delta, of the surfaces in the images.
enum class ContactStatus : std::uint8_t {
  ruled_out,  ///< nothing is: no contact is reported, and none has been missed
  undecided,  ///< no contact is reported, but the budget or the level of detail did not do for
              ///< ruling one out
  found,      ///< contacts are reported
};

/// What is certain about the answer.
struct Certificate {
  ContactStatus contact = ContactStatus::undecided;
  double error_bound_m = 0;  ///< the true least distance is within this of the reported one; where
                             ///< no contact is reported, of delta. It counts what detail was left
                             ///< out before baking (Header::source_deviation_rel)
  double s_worst =
      0;  ///< largest weighted surface deviation left unrefined, relative to the radius
  /// How far the force is off at most, before limits (force/least_push.hpp). It counts what detail
  /// was left out of both bodies before baking, of which no tolerance takes account. Levels engine,
  /// where the surfaces have not been asked: hardly more than that the force is finite.
  double force_bound_N = 0;
  std::uint64_t units_used = 0;
  bool truncated_by_time = false;  ///< the clock ended refinement
  /// The work units ended refinement. Where surfaces give the force: or not all is proved, of which
  /// a tick that is neither exact nor has a tolerance takes on a few hundred units.
  bool truncated_by_units = false;
  bool truncated_by_memory = false;  ///< nodes, contacts or clusters were used up
  bool iteration_cap_met = false;    ///< a convex query gave its best so far
  bool on_reserve = false;           ///< it went on for a first contact (Budget::reserve_units)
  [[nodiscard]] bool truncated() const noexcept {
    return truncated_by_time || truncated_by_units || truncated_by_memory;
  }
};

struct TickResult {
  Wrench wrench;  ///< on the tool, world axes, torque about the origin of the tool's body frame
  /// How the wrench falls as the tool moves by a small twist, with shares and normals held; J_i =
  /// [n_i | r_i x n_i]: 2 k J^T M^-1 J of the contacts that carry, M their Gram matrix. Positive
  /// semidefinite, before limits. With it a faster loop may render between ticks: wrench -
  /// stiffness * (twist since the tick).
  Matrix6 stiffness;
  std::span<const Contact> contacts;  ///< valid until the next tick; order is deterministic
  std::uint32_t clusters = 0;         ///< contacts that carry the push, at most nine
  double min_distance_m =
      std::numeric_limits<double>::quiet_NaN();  ///< least over contacts; NaN where there are none
  std::uint64_t front_nodes =
      0;  ///< leaves of the bounding volume test tree at the end of the tick; near regions
  std::uint64_t queries = 0;  ///< work units: convex-pair queries; for regions, boxes against the
                              ///< boxes of a node (a batch of triangle pairs counts as 8)
  Certificate certificate;
};

class Engine;

/// Bytes that create() needs for this scene and these limits; 0 where the scene or the limits are
/// out of range. O(bodies).
[[nodiscard]] std::size_t required_bytes(const Scene& scene, const Limits& limits,
                                         EngineKind engine = EngineKind::levels) noexcept;

/// Makes an engine inside `memory` (64-byte aligned, at least required_bytes). It needs no
/// destruction: drop the memory. Errors: bad_argument, not_enough_memory, image_missing_section,
/// image_too_coarse. Touches every byte of the memory it will use.
Status create(const Scene& scene, const Settings& settings, const Limits& limits,
              std::span<std::byte> memory, Engine*& out_engine) noexcept;

/// Replaces the settings between ticks; the kind of engine stays. Errors: bad_argument,
/// image_too_coarse (nothing is changed). O(pairs).
Status configure(Engine& engine, const Settings& settings) noexcept;

/// One contact query and its wrench.
///
/// @param poses  [bodies] body to world; finite, quaternions of unit length within 1e-3 (they are
/// normalised)
/// @param out    written only where the result is Status::ok
/// Errors: bad_pose, bad_argument. Cost: the budget and its reserve, plus at most one convex query
/// (where surfaces give the force: the closest points known of each near region, or the contacts of
/// one vertex or edge) and a tail that is linear in the front and in contacts *
/// log(contacts), and for which time is left before the deadline. An exact query of the levels
/// engine that has no budget is done twice in the first tick in which its nodes or contacts do not
/// fit. No allocation, no lock, no recursion, bounded stack.
Status tick(Engine& engine, std::span<const Pose> poses, const Budget& budget,
            TickResult& out) noexcept;

}  // namespace palpate
