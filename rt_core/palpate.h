/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The contact engine for C and for whatever calls C. The same engine, units, ranges, errors and
 * costs as palpate_rt.hpp, which says more; docs/EMBEDDING.md shows a whole loop.
 *
 * SI units; quaternions w x y z, body to world; wrenches, contacts and poses in world axes. Nothing
 * here allocates, locks or reads a clock of its own. The result of every function that can fail is
 * a palpate_status: 0, or the number that palpate_describe() names. A null pointer where something
 * is to be read or written is PALPATE_BAD_ARGUMENT.
 */
#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NOLINTBEGIN(readability-identifier-naming): names as in C */
typedef uint16_t palpate_status;
#define PALPATE_OK 0u
#define PALPATE_BAD_ARGUMENT 100u

/* Text of a status, static storage, never null. */
const char* palpate_describe(palpate_status status);

#define PALPATE_IMAGE_WORDS 38

/* A validated image, used in place: its bytes must outlive it. */
typedef struct palpate_image {
  const void* opaque[PALPATE_IMAGE_WORDS];
} palpate_image;

/* Proves that the bytes are a sound image. bytes: the whole image, on a 64-byte boundary. */
palpate_status palpate_open(const void* bytes, size_t size, palpate_image* out);

typedef struct palpate_pair {
  uint32_t a, b; /* bodies; normals point from b to a */
} palpate_pair;

/* Arrays must outlive the engine. */
typedef struct palpate_scene {
  const palpate_image* images; /* [bodies] */
  uint32_t bodies;
  const palpate_pair* pairs; /* [pair_count] */
  uint32_t pair_count;
  uint32_t tool; /* the body that the device holds */
} palpate_scene;

enum { PALPATE_LEVELS = 0, PALPATE_REGIONS = 1 };
enum { PALPATE_BOUNDS_TIGHT = 0, PALPATE_BOUNDS_PAPER = 1 };
enum { PALPATE_BY_DEVIATION = 0, PALPATE_BY_FORCE = 1 };

/* Start from palpate_default_settings(): fields are only ever added. */
typedef struct palpate_settings {
  uint32_t engine;      /* fixed when the engine is made */
  uint32_t exact;       /* 0 or 1: prove the wrench */
  uint32_t interpolate; /* not used any more */
  uint32_t bounds;
  uint32_t order;
  double delta_m;
  double s0;
  double kappa; /* infinity: no such rule */
  double force_tolerance_N;
  double stiffness_N_per_m; /* with 0, exact queries give distances alone */
  double cluster_radius_m;
  double max_force_N;
  double max_torque_Nm;
} palpate_settings;

typedef struct palpate_limits {
  uint32_t nodes, contacts, clusters;
} palpate_limits;

void palpate_default_settings(palpate_settings* out);
void palpate_default_limits(palpate_limits* out);

typedef struct palpate_engine palpate_engine;

/* Bytes that palpate_create() needs; 0 where the arguments are out of range. */
size_t palpate_required_bytes(const palpate_scene* scene, const palpate_limits* limits,
                              uint32_t engine);

/* Makes an engine in `memory` (on a 64-byte boundary). It needs no destruction. */
palpate_status palpate_create(const palpate_scene* scene, const palpate_settings* settings,
                              const palpate_limits* limits, void* memory, size_t size,
                              palpate_engine** out);

/* Makes an engine of a copy of another one's memory, at any 64-byte boundary: the first
 * palpate_required_bytes() bytes, copied between ticks. Same scene (equal images), limits and
 * engine; same build. See workspace.hpp. */
palpate_status palpate_restore(const palpate_scene* scene, const palpate_limits* limits,
                               uint32_t engine, void* memory, size_t size, palpate_engine** out);

palpate_status palpate_configure(palpate_engine* engine, const palpate_settings* settings);

typedef struct palpate_pose {
  double position_m[3];
  double orientation[4];
} palpate_pose;

/* Refinement ends at whichever comes first. units: UINT64_MAX for no limit; clock_ns: a monotonic
 * clock, or null for none. */
typedef struct palpate_budget {
  uint64_t units;
  uint64_t (*clock_ns)(void* context);
  void* clock_context;
  uint64_t deadline_ns;
  /* More of each, for a tick of PALPATE_REGIONS that by then feels nothing of two bodies and cannot
   * rule out that they touch; 0: none, UINT64_MAX: until that is answered (palpate_rt.hpp). */
  uint64_t reserve_units, reserve_ns;
} palpate_budget;

typedef struct palpate_contact {
  /* World axes. normal: unit, from b to a, not always along the points (palpate_rt.hpp). */
  double point_a_m[3], point_b_m[3], normal[3];
  double distance_m, weight;
  uint32_t pair, piece_a, level_a, piece_b, level_b, reserved;
  /* Where its force acts: between the points or, where wide faces meet, beside that. */
  double centre_m[3];
} palpate_contact;

/* Without contacts: is it certain that nothing is nearer than delta (ContactStatus)? */
enum { PALPATE_CONTACT_RULED_OUT = 0, PALPATE_CONTACT_UNDECIDED = 1, PALPATE_CONTACT_FOUND = 2 };

typedef struct palpate_result {
  double force_N[3], torque_Nm[3]; /* on the tool, torque about the tool's origin */
  double min_distance_m;           /* NaN without contacts */
  double error_bound_m, s_worst, force_bound_N;
  uint64_t units_used, queries, front_nodes;
  uint32_t contacts, clusters;
  uint32_t truncated_by_time, truncated_by_units, truncated_by_memory, iteration_cap_met;
  uint32_t contact; /* PALPATE_CONTACT_... */
  uint32_t on_reserve;
} palpate_result;

/* One contact query and its wrench. poses: [bodies]. */
palpate_status palpate_tick(palpate_engine* engine, const palpate_pose* poses,
                            const palpate_budget* budget, palpate_result* out);

/* Contact `index` of the last tick. */
palpate_status palpate_get_contact(const palpate_engine* engine, uint32_t index,
                                   palpate_contact* out);

/* The wrench of the last tick at a pose of the tool nearby: wrench - stiffness * displacement, for
 * a loop that is faster than the contact query (force/linear_contact.hpp). */
palpate_status palpate_predict(const palpate_engine* engine, const palpate_pose* tool,
                               double force_N[3], double torque_Nm[3]);

#define PALPATE_STICK_WORDS 18

/* What sticks between the tool and one other body (force/friction.hpp). */
typedef struct palpate_stick {
  double opaque[PALPATE_STICK_WORDS];
} palpate_stick;

/* Nothing touches: at the start, and after a jump of the poses. sticks: [count] */
void palpate_release(palpate_stick* sticks, uint32_t count);

/* Adds Coulomb friction with stick to the wrench of the last tick, which palpate_predict(),
 * palpate_damp() and palpate_step_coupling() then start from. Once after each tick. The engine's
 * own limits of force belong off then. coefficients: [pair_count], >= 0, 0 for none; sticks:
 * [pair_count], one engine's. O(contacts + pairs). */
palpate_status palpate_add_friction(palpate_engine* engine, const double* coefficients,
                                    palpate_stick* sticks, double force_N[3], double torque_Nm[3]);

/* The wrench of the last tick with contacts that resist the tool's velocity, by at most their own
 * force (force/linear_contact.hpp). Velocities of the tool's origin and of its turning, world axes.
 * damping_s: damping over stiffness, >= 0. O(1). */
palpate_status palpate_damp(const palpate_engine* engine, const double linear_m_per_s[3],
                            const double angular_rad_per_s[3], double damping_s, double force_N[3],
                            double torque_Nm[3]);

/* Virtual coupling (force/coupling.hpp): the hand feels a spring to a simulated tool that feels the
 * contacts, however stiff they are. The engine's own limits of force belong off then. */
typedef struct palpate_coupling_settings {
  double spring_N_per_m, spring_Nm_per_rad; /* > 0; the damper beside them is critical */
  double mass_kg, inertia_kg_m2;            /* > 0; of the simulated tool */
  double contact_damping_s;                 /* >= 0; damping of contacts over their stiffness */
} palpate_coupling_settings;

void palpate_default_coupling(palpate_coupling_settings* out);

#define PALPATE_COUPLING_WORDS 32

/* A simulated tool. Plain memory: may be copied. */
typedef struct palpate_coupling {
  double opaque[PALPATE_COUPLING_WORDS];
} palpate_coupling;

/* Puts the simulated tool at rest where the handle is. */
palpate_status palpate_couple(const palpate_coupling_settings* settings, const palpate_pose* handle,
                              palpate_coupling* out);

/* Where the simulated tool is: the pose to tick the engine with. */
palpate_status palpate_coupled_pose(const palpate_coupling* coupling, palpate_pose* out);

/* Moves the simulated tool on by one period under the last tick's contacts; gives the wrench for
 * the handle, about its origin. Once after each tick. period_s: > 0. Constant cost. */
palpate_status palpate_step_coupling(palpate_coupling* coupling, const palpate_engine* engine,
                                     const palpate_pose* handle, double period_s, double force_N[3],
                                     double torque_Nm[3]);

/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif
#endif /* PALPATE_H */
