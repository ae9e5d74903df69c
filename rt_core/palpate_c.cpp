// SPDX-License-Identifier: Apache-2.0
// palpate.h over palpate_rt.hpp.
#include <cstdint>
#include <limits>
#include <new>
#include <type_traits>

#include "rt_core/base/arena.hpp"
#include "rt_core/force/coupling.hpp"
#include "rt_core/force/friction.hpp"
#include "rt_core/force/linear_contact.hpp"
#include "rt_core/palpate.h"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/workspace.hpp"

/// What palpate_create() puts in front of the engine.
struct palpate_engine {
  palpate::Pose poses[palpate::kMaxBodies];
  std::uint32_t bodies = 0;
  palpate::Engine* engine = nullptr;
  std::span<const palpate::Contact> contacts;
  std::uint32_t tool = 0;
  palpate::force::LinearContact felt;  // of the last tick, with what was added to it
  std::span<const palpate::BodyPair> pairs;
  palpate::Settings settings;
};

namespace palpate {
namespace {

// Arrays of the one are read as arrays of the other.
static_assert(sizeof(ImageView) == sizeof(palpate_image));
static_assert(alignof(ImageView) == alignof(palpate_image));
static_assert(sizeof(BodyPair) == sizeof(palpate_pair));
static_assert(offsetof(BodyPair, b) == offsetof(palpate_pair, b));
static_assert(std::is_trivially_copyable_v<ImageView> && std::is_standard_layout_v<BodyPair>);

constexpr std::size_t kFront =
    (sizeof(palpate_engine) + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment;

palpate_status code(Status status) noexcept { return static_cast<palpate_status>(status); }

bool sound(const palpate_scene* scene) noexcept {
  return scene != nullptr && scene->images != nullptr && scene->pairs != nullptr &&
         scene->bodies >= 1 && scene->bodies <= kMaxBodies && scene->pair_count >= 1 &&
         scene->pair_count <= kMaxPairs;
}

template <class To>
const To* as(const void* from) noexcept {
  return std::launder(static_cast<const To*>(from));
}

Scene scene_of(const palpate_scene& from) noexcept {
  return {{as<ImageView>(from.images), from.bodies},
          {as<BodyPair>(from.pairs), from.pair_count},
          from.tool};
}

Limits limits_of(const palpate_limits& from) noexcept {
  return {.nodes = from.nodes, .contacts = from.contacts, .clusters = from.clusters};
}

/// False where an enumeration is out of range.
bool settings_of(const palpate_settings& from, Settings& out) noexcept {
  if (from.engine > PALPATE_REGIONS || from.exact > 1 || from.bounds > PALPATE_BOUNDS_PAPER ||
      from.order > PALPATE_BY_FORCE) {
    return false;
  }
  out.engine = static_cast<EngineKind>(from.engine);
  out.exact = from.exact != 0;
  out.bounds = static_cast<Bounds>(from.bounds);
  out.order = static_cast<Order>(from.order);
  out.delta_m = from.delta_m;
  out.s0 = from.s0;
  out.kappa = from.kappa;
  out.force_tolerance_N = from.force_tolerance_N;
  out.stiffness_N_per_m = from.stiffness_N_per_m;
  out.cluster_radius_m = from.cluster_radius_m;
  out.max_force_N = from.max_force_N;
  out.max_torque_Nm = from.max_torque_Nm;
  return true;
}

void put(Vec3d from, double* to) noexcept {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

void put(const TickResult& from, palpate_result& to) noexcept {
  put(from.wrench.force_N, to.force_N);
  put(from.wrench.torque_Nm, to.torque_Nm);
  to.min_distance_m = from.min_distance_m;
  to.error_bound_m = from.certificate.error_bound_m;
  to.s_worst = from.certificate.s_worst;
  to.force_bound_N = from.certificate.force_bound_N;
  to.units_used = from.certificate.units_used;
  to.queries = from.queries;
  to.front_nodes = from.front_nodes;
  to.contacts = static_cast<std::uint32_t>(from.contacts.size());
  to.clusters = from.clusters;
  to.truncated_by_time = from.certificate.truncated_by_time ? 1 : 0;
  to.truncated_by_units = from.certificate.truncated_by_units ? 1 : 0;
  to.truncated_by_memory = from.certificate.truncated_by_memory ? 1 : 0;
  to.iteration_cap_met = from.certificate.iteration_cap_met ? 1 : 0;
  to.contact = static_cast<std::uint32_t>(from.certificate.contact);
  to.on_reserve = from.certificate.on_reserve ? 1 : 0;
}

Pose pose_of(const palpate_pose& from) noexcept {
  const double* p = from.position_m;
  const double* q = from.orientation;
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

bool finite(double v) noexcept { return v - v == 0; }

/// As the engine judges poses.
bool sound(const palpate_pose* pose) noexcept {
  if (pose == nullptr) return false;
  double squared = 0;
  for (const double v : pose->orientation) squared += v * v;
  for (const double v : pose->position_m) {
    if (!finite(v)) return false;
  }
  constexpr double kUnitQuaternion = 1e-3;
  const double length = sqrt_of(squared);
  return length >= 1 - kUnitQuaternion && length <= 1 + kUnitQuaternion;
}

bool sound(const palpate_coupling_settings* s) noexcept {
  if (s == nullptr || !finite(s->contact_damping_s) || !(s->contact_damping_s >= 0)) return false;
  for (const double v : {s->spring_N_per_m, s->spring_Nm_per_rad, s->mass_kg, s->inertia_kg_m2}) {
    if (!finite(v) || !(v > 0)) return false;
  }
  return true;
}

static_assert(sizeof(force::VirtualTool) <= sizeof(palpate_coupling));
static_assert(alignof(force::VirtualTool) <= alignof(palpate_coupling));
static_assert(std::is_trivially_copyable_v<force::VirtualTool>);

static_assert(sizeof(force::Stick) == sizeof(palpate_stick));
static_assert(alignof(force::Stick) <= alignof(palpate_stick));
static_assert(std::is_trivially_copyable_v<force::Stick>);

bool sound(std::span<const double> coefficients) noexcept {
  for (const double c : coefficients) {
    if (!finite(c) || !(c >= 0)) return false;
  }
  return true;
}

force::VirtualTool* tool_of(palpate_coupling* coupling) noexcept {
  return std::launder(static_cast<force::VirtualTool*>(static_cast<void*>(coupling->opaque)));
}
const force::VirtualTool* tool_of(const palpate_coupling* coupling) noexcept {
  return as<force::VirtualTool>(coupling->opaque);
}

Budget budget_of(const palpate_budget& from) noexcept {
  return {.units = from.units,
          .clock_ns = from.clock_ns,
          .clock_context = from.clock_context,
          .deadline_ns = from.deadline_ns,
          .reserve_units = from.reserve_units,
          .reserve_ns = from.reserve_ns};
}

}  // namespace
}  // namespace palpate

using palpate::Status;

extern "C" {

const char* palpate_describe(palpate_status status) {
  return palpate::describe(static_cast<Status>(status));
}

palpate_status palpate_open(const void* bytes, size_t size, palpate_image* out) {
  if (bytes == nullptr || out == nullptr) return PALPATE_BAD_ARGUMENT;
  palpate::ImageView view;
  const Status status = palpate::validate({static_cast<const std::byte*>(bytes), size}, view);
  if (status == Status::ok) new (out->opaque) palpate::ImageView(view);
  return palpate::code(status);
}

void palpate_default_settings(palpate_settings* out) {
  if (out == nullptr) return;
  const palpate::Settings s;
  *out = {static_cast<std::uint32_t>(s.engine),
          s.exact ? 1u : 0u,
          0u,
          static_cast<std::uint32_t>(s.bounds),
          static_cast<std::uint32_t>(s.order),
          s.delta_m,
          s.s0,
          s.kappa,
          s.force_tolerance_N,
          s.stiffness_N_per_m,
          s.cluster_radius_m,
          s.max_force_N,
          s.max_torque_Nm};
}

void palpate_default_limits(palpate_limits* out) {
  if (out == nullptr) return;
  const palpate::Limits limits;
  *out = {limits.nodes, limits.contacts, limits.clusters};
}

size_t palpate_required_bytes(const palpate_scene* scene, const palpate_limits* limits,
                              uint32_t engine) {
  if (!palpate::sound(scene) || limits == nullptr || engine > PALPATE_REGIONS) return 0;
  const std::size_t bytes =
      palpate::required_bytes(palpate::scene_of(*scene), palpate::limits_of(*limits),
                              static_cast<palpate::EngineKind>(engine));
  return bytes == 0 ? 0 : palpate::kFront + bytes;
}

palpate_status palpate_create(const palpate_scene* scene, const palpate_settings* settings,
                              const palpate_limits* limits, void* memory, size_t size,
                              palpate_engine** out) {
  palpate::Settings how;
  if (!palpate::sound(scene) || settings == nullptr || limits == nullptr || memory == nullptr ||
      out == nullptr || !palpate::settings_of(*settings, how)) {
    return PALPATE_BAD_ARGUMENT;
  }
  palpate::Arena arena({static_cast<std::byte*>(memory), size});
  const std::span<palpate_engine> made = arena.array<palpate_engine>(1);
  if (made.empty()) return palpate::code(Status::not_enough_memory);
  palpate_engine* front = made.data();
  front->bodies = scene->bodies;
  front->tool = scene->tool;
  front->pairs = palpate::scene_of(*scene).pairs;
  front->settings = how;
  const Status status = palpate::create(
      palpate::scene_of(*scene), how, palpate::limits_of(*limits),
      {static_cast<std::byte*>(memory) + palpate::kFront, size - palpate::kFront}, front->engine);
  if (status == Status::ok) *out = front;
  return palpate::code(status);
}

palpate_status palpate_restore(const palpate_scene* scene, const palpate_limits* limits,
                               uint32_t engine, void* memory, size_t size, palpate_engine** out) {
  if (!palpate::sound(scene) || limits == nullptr || engine > PALPATE_REGIONS ||
      memory == nullptr || out == nullptr) {
    return PALPATE_BAD_ARGUMENT;
  }
  palpate::Arena arena({static_cast<std::byte*>(memory), size}, palpate::Arena::Contents::kept);
  const std::span<palpate_engine> kept = arena.array<palpate_engine>(1);
  if (kept.empty()) return palpate::code(Status::not_enough_memory);
  palpate::Engine* found = nullptr;
  const Status status = palpate::restore(
      palpate::scene_of(*scene), palpate::limits_of(*limits),
      static_cast<palpate::EngineKind>(engine),
      {static_cast<std::byte*>(memory) + palpate::kFront, size - palpate::kFront}, found);
  if (status != Status::ok) return palpate::code(status);
  kept[0].bodies = scene->bodies;
  kept[0].engine = found;
  kept[0].pairs = palpate::scene_of(*scene).pairs;
  kept[0].contacts = {};  // those of the last tick are read before the copy is made
  *out = kept.data();
  return PALPATE_OK;
}

palpate_status palpate_configure(palpate_engine* engine, const palpate_settings* settings) {
  palpate::Settings how;
  if (engine == nullptr || settings == nullptr || !palpate::settings_of(*settings, how))
    return PALPATE_BAD_ARGUMENT;
  const Status status = palpate::configure(*engine->engine, how);
  if (status == Status::ok) engine->settings = how;
  return palpate::code(status);
}

palpate_status palpate_tick(palpate_engine* engine, const palpate_pose* poses,
                            const palpate_budget* budget, palpate_result* out) {
  if (engine == nullptr || poses == nullptr || budget == nullptr || out == nullptr)
    return PALPATE_BAD_ARGUMENT;
  for (std::uint32_t i = 0; i < engine->bodies; ++i) {
    engine->poses[i] = palpate::pose_of(poses[i]);
  }
  palpate::TickResult result;
  const Status status = palpate::tick(*engine->engine, {engine->poses, engine->bodies},
                                      palpate::budget_of(*budget), result);
  if (status != Status::ok) return palpate::code(status);
  engine->contacts = result.contacts;
  engine->felt = {engine->poses[engine->tool], result.wrench, result.stiffness};
  palpate::put(result, *out);
  return PALPATE_OK;
}

palpate_status palpate_get_contact(const palpate_engine* engine, uint32_t index,
                                   palpate_contact* out) {
  if (engine == nullptr || out == nullptr || index >= engine->contacts.size())
    return PALPATE_BAD_ARGUMENT;
  const palpate::Contact& c = engine->contacts[index];
  palpate::put(c.point_a_m, out->point_a_m);
  palpate::put(c.point_b_m, out->point_b_m);
  palpate::put(c.normal, out->normal);
  out->distance_m = c.distance_m;
  out->weight = c.weight;
  out->pair = c.pair;
  out->piece_a = c.piece_a;
  out->level_a = c.level_a;
  out->piece_b = c.piece_b;
  out->level_b = c.level_b;
  out->reserved = 0;
  palpate::put(c.centre_m, out->centre_m);
  return PALPATE_OK;
}

palpate_status palpate_predict(const palpate_engine* engine, const palpate_pose* tool,
                               double force_N[3], double torque_Nm[3]) {
  if (engine == nullptr || tool == nullptr || force_N == nullptr || torque_Nm == nullptr)
    return PALPATE_BAD_ARGUMENT;
  if (!palpate::sound(tool)) return palpate::code(Status::bad_pose);
  const palpate::Wrench wrench = palpate::force::predicted(engine->felt, palpate::pose_of(*tool));
  palpate::put(wrench.force_N, force_N);
  palpate::put(wrench.torque_Nm, torque_Nm);
  return PALPATE_OK;
}

void palpate_release(palpate_stick* sticks, uint32_t count) {
  if (sticks == nullptr) return;
  for (std::uint32_t i = 0; i < count; ++i) new (sticks[i].opaque) palpate::force::Stick();
}

palpate_status palpate_add_friction(palpate_engine* engine, const double* coefficients,
                                    palpate_stick* sticks, double force_N[3], double torque_Nm[3]) {
  if (engine == nullptr || coefficients == nullptr || sticks == nullptr || force_N == nullptr ||
      torque_Nm == nullptr || !palpate::sound({coefficients, engine->pairs.size()})) {
    return PALPATE_BAD_ARGUMENT;
  }
  const std::size_t pairs = engine->pairs.size();
  auto* first = std::launder(static_cast<palpate::force::Stick*>(static_cast<void*>(sticks)));
  palpate::force::Friction friction({coefficients, pairs}, {first, pairs});
  palpate::TickResult result;
  result.wrench = engine->felt.wrench;
  result.stiffness = engine->felt.stiffness;
  result.contacts = engine->contacts;
  friction.add(engine->pairs, engine->tool, engine->settings, {engine->poses, engine->bodies},
               result);
  engine->felt.wrench = result.wrench;
  engine->felt.stiffness = result.stiffness;
  palpate::put(result.wrench.force_N, force_N);
  palpate::put(result.wrench.torque_Nm, torque_Nm);
  return PALPATE_OK;
}

palpate_status palpate_damp(const palpate_engine* engine, const double linear_m_per_s[3],
                            const double angular_rad_per_s[3], double damping_s, double force_N[3],
                            double torque_Nm[3]) {
  if (engine == nullptr || linear_m_per_s == nullptr || angular_rad_per_s == nullptr ||
      force_N == nullptr || torque_Nm == nullptr || !palpate::finite(damping_s) ||
      !(damping_s >= 0)) {
    return PALPATE_BAD_ARGUMENT;
  }
  palpate::Vec6 velocity{};
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i] = linear_m_per_s[i];
    velocity[i + 3] = angular_rad_per_s[i];
    if (!palpate::finite(velocity[i]) || !palpate::finite(velocity[i + 3])) {
      return PALPATE_BAD_ARGUMENT;
    }
  }
  const palpate::force::LinearContact& felt = engine->felt;
  const palpate::Wrench wrench =
      palpate::force::damped(felt.wrench, felt.stiffness, velocity, damping_s);
  palpate::put(wrench.force_N, force_N);
  palpate::put(wrench.torque_Nm, torque_Nm);
  return PALPATE_OK;
}

void palpate_default_coupling(palpate_coupling_settings* out) {
  if (out == nullptr) return;
  const palpate::force::CouplingSettings s;
  *out = {s.spring_N_per_m, s.spring_Nm_per_rad, s.mass_kg, s.inertia_kg_m2, s.contact_damping_s};
}

palpate_status palpate_couple(const palpate_coupling_settings* settings, const palpate_pose* handle,
                              palpate_coupling* out) {
  if (!palpate::sound(settings) || handle == nullptr || out == nullptr) return PALPATE_BAD_ARGUMENT;
  if (!palpate::sound(handle)) return palpate::code(Status::bad_pose);
  auto* tool = new (out->opaque) palpate::force::VirtualTool(
      {settings->spring_N_per_m, settings->spring_Nm_per_rad, settings->mass_kg,
       settings->inertia_kg_m2, settings->contact_damping_s});
  tool->reset(palpate::pose_of(*handle));
  return PALPATE_OK;
}

palpate_status palpate_coupled_pose(const palpate_coupling* coupling, palpate_pose* out) {
  if (coupling == nullptr || out == nullptr) return PALPATE_BAD_ARGUMENT;
  const palpate::Pose& pose = palpate::tool_of(coupling)->pose();
  palpate::put(pose.position_m, out->position_m);
  const palpate::Quat& q = pose.orientation;
  out->orientation[0] = q.w;
  out->orientation[1] = q.x;
  out->orientation[2] = q.y;
  out->orientation[3] = q.z;
  return PALPATE_OK;
}

palpate_status palpate_step_coupling(palpate_coupling* coupling, const palpate_engine* engine,
                                     const palpate_pose* handle, double period_s, double force_N[3],
                                     double torque_Nm[3]) {
  if (coupling == nullptr || engine == nullptr || handle == nullptr || force_N == nullptr ||
      torque_Nm == nullptr || !palpate::finite(period_s) || !(period_s > 0)) {
    return PALPATE_BAD_ARGUMENT;
  }
  if (!palpate::sound(handle)) return palpate::code(Status::bad_pose);
  const palpate::force::LinearContact& felt = engine->felt;
  const palpate::Wrench wrench = palpate::tool_of(coupling)->step(
      palpate::pose_of(*handle), felt.wrench, felt.stiffness, period_s);
  palpate::put(wrench.force_N, force_N);
  palpate::put(wrench.torque_Nm, torque_Nm);
  return PALPATE_OK;
}

}  // extern "C"
