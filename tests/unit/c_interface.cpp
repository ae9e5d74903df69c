// SPDX-License-Identifier: Apache-2.0
// palpate.h gives what palpate_rt.hpp gives, and refuses what it is not given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "../support/tiny_image.hpp"
#include "rt_core/force/coupling.hpp"
#include "rt_core/force/friction.hpp"
#include "rt_core/force/linear_contact.hpp"
#include "rt_core/palpate.h"
#include "rt_core/palpate_rt.hpp"

extern "C" {
int run(const void*, size_t, const void*, size_t);
int read_device(palpate_pose* tool);
void push_device(const double force_N[3], const double torque_Nm[3]);
uint64_t cycle_ns(void* context);
}

namespace palpate::test {
namespace {

AlignedBytes ball() { return seal(parts_of({ball_part(0.9f, 9, 14)})); }
AlignedBytes block() { return seal(parts_of({box_part({0, 0, 0}, {0.5f, 0.5f, 0.5f})})); }

constexpr int kTicks = 40;

Pose pose_of(int tick) {
  const double angle = 0.01 * tick;
  return {{1.5 - 0.004 * tick, 0.1, 0.05}, {std::cos(angle), 0, std::sin(angle), 0}};
}

palpate_pose c_pose_of(const Pose& p) {
  return {{p.position_m.x, p.position_m.y, p.position_m.z},
          {p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z}};
}

std::vector<Vec3d> g_pushed;
int g_tick = 0;

/// The scene of these tests in C++, to compare with.
struct CppScene {
  CppScene() {
    EXPECT_EQ(validate(a, views[0]), Status::ok);
    EXPECT_EQ(validate(b, views[1]), Status::ok);
    const Scene scene{views, pairs, 0};
    memory.resize(required_bytes(scene, {}));
    EXPECT_EQ(create(scene, settings, {}, memory, engine), Status::ok);
  }

  AlignedBytes a = ball(), b = block();
  ImageView views[2];
  BodyPair pairs[1] = {{0, 1}};
  Settings settings{.delta_m = 0.1};
  AlignedBytes memory;
  Engine* engine = nullptr;
};

TEST(CInterface, gives_the_same_bits_as_the_engine) {
  const CppScene same;
  const AlignedBytes &a = same.a, &b = same.b;
  palpate_image images[2];
  ASSERT_EQ(palpate_open(a.data(), a.size(), &images[0]), PALPATE_OK);
  ASSERT_EQ(palpate_open(b.data(), b.size(), &images[1]), PALPATE_OK);
  const palpate_pair c_pairs[1] = {{0, 1}};
  const palpate_scene c_scene{images, 2, c_pairs, 1, 0};
  palpate_settings c_settings;
  palpate_limits c_limits;
  palpate_default_settings(&c_settings);
  palpate_default_limits(&c_limits);
  c_settings.delta_m = 0.1;
  AlignedBytes c_memory(palpate_required_bytes(&c_scene, &c_limits, PALPATE_LEVELS));
  palpate_engine* c_engine = nullptr;
  EXPECT_EQ(palpate_create(&c_scene, &c_settings, &c_limits, c_memory.data(), c_memory.size() - 1,
                           &c_engine),
            static_cast<palpate_status>(Status::not_enough_memory));
  ASSERT_EQ(
      palpate_create(&c_scene, &c_settings, &c_limits, c_memory.data(), c_memory.size(), &c_engine),
      PALPATE_OK);

  std::uint32_t contacts = 0;
  AlignedBytes moved;
  for (int i = 0; i < kTicks; ++i) {
    if (i == kTicks / 2) {  // the engine goes on elsewhere
      moved = c_memory;
      std::fill(c_memory.begin(), c_memory.end(), std::byte{0xa5});
      ASSERT_EQ(palpate_restore(&c_scene, &c_limits, PALPATE_LEVELS, moved.data(), moved.size(),
                                &c_engine),
                PALPATE_OK);
    }
    const Pose poses[2] = {pose_of(i), {}};
    const palpate_pose c_poses[2] = {c_pose_of(poses[0]), c_pose_of(poses[1])};
    TickResult r;
    palpate_result c;
    ASSERT_EQ(tick(*same.engine, poses, {.units = 50}, r), Status::ok);
    const palpate_budget budget{50, nullptr, nullptr, 0, 0, 0};
    ASSERT_EQ(palpate_tick(c_engine, c_poses, &budget, &c), PALPATE_OK);
    EXPECT_EQ(std::memcmp(c.force_N, &r.wrench.force_N, sizeof c.force_N), 0);
    EXPECT_EQ(std::memcmp(c.torque_Nm, &r.wrench.torque_Nm, sizeof c.torque_Nm), 0);
    EXPECT_EQ(c.error_bound_m, r.certificate.error_bound_m);
    EXPECT_EQ(c.queries, r.queries);
    EXPECT_EQ(c.contact, static_cast<std::uint32_t>(r.certificate.contact));
    ASSERT_EQ(c.contacts, r.contacts.size());
    contacts += c.contacts;
    for (std::uint32_t k = 0; k < c.contacts; ++k) {
      palpate_contact contact;
      ASSERT_EQ(palpate_get_contact(c_engine, k, &contact), PALPATE_OK);
      EXPECT_EQ(contact.distance_m, r.contacts[k].distance_m);
      EXPECT_EQ(contact.normal[2], r.contacts[k].normal.z);
      EXPECT_EQ(contact.centre_m[1], r.contacts[k].centre_m.y);
      EXPECT_EQ(contact.piece_a, r.contacts[k].piece_a);
    }
    palpate_contact none;
    EXPECT_EQ(palpate_get_contact(c_engine, c.contacts, &none), PALPATE_BAD_ARGUMENT);
  }
  EXPECT_GT(contacts, 0u);
}

/// An engine in C with its memory.
struct CScene {
  AlignedBytes a = ball(), b = block();
  palpate_image images[2];
  palpate_pair pairs[1] = {{0, 1}};
  palpate_limits limits;
  AlignedBytes memory{0};
  palpate_engine* engine = nullptr;

  CScene() {
    EXPECT_EQ(palpate_open(a.data(), a.size(), &images[0]), PALPATE_OK);
    EXPECT_EQ(palpate_open(b.data(), b.size(), &images[1]), PALPATE_OK);
    palpate_default_limits(&limits);
    const palpate_scene scene{images, 2, pairs, 1, 0};
    palpate_settings settings;
    palpate_default_settings(&settings);
    settings.delta_m = 0.1;
    memory = AlignedBytes(palpate_required_bytes(&scene, &limits, PALPATE_LEVELS));
    EXPECT_EQ(palpate_create(&scene, &settings, &limits, memory.data(), memory.size(), &engine),
              PALPATE_OK);
  }
  palpate_result tick(const palpate_pose& tool) {
    const palpate_pose poses[2] = {tool, {{0, 0, 0}, {1, 0, 0, 0}}};
    const palpate_budget budget{UINT64_MAX, nullptr, nullptr, 0, 0, 0};
    palpate_result result;
    EXPECT_EQ(palpate_tick(engine, poses, &budget, &result), PALPATE_OK);
    return result;
  }
};

TEST(CInterface, coupling_gives_the_same_bits_as_the_simulated_tool) {
  constexpr double kPeriod_s = 0.001;
  CScene scene;
  palpate_coupling_settings settings;
  palpate_default_coupling(&settings);
  palpate_coupling coupling;
  const palpate_pose start = c_pose_of(pose_of(0));
  ASSERT_EQ(palpate_couple(&settings, &start, &coupling), PALPATE_OK);

  const AlignedBytes a = ball(), b = block();
  ImageView views[2];
  ASSERT_EQ(validate(a, views[0]), Status::ok);
  ASSERT_EQ(validate(b, views[1]), Status::ok);
  const BodyPair pairs[1] = {{0, 1}};
  const Scene same{views, pairs, 0};
  AlignedBytes memory(required_bytes(same, {}));
  Engine* engine = nullptr;
  ASSERT_EQ(create(same, {.delta_m = 0.1}, {}, memory, engine), Status::ok);
  force::VirtualTool tool({});
  tool.reset(pose_of(0));

  double pushed_N = 0;
  for (int i = 0; i < kTicks; ++i) {
    palpate_pose at;
    ASSERT_EQ(palpate_coupled_pose(&coupling, &at), PALPATE_OK);
    scene.tick(at);
    const palpate_pose handle = c_pose_of(pose_of(i));
    double force_N[3], torque_Nm[3];
    ASSERT_EQ(
        palpate_step_coupling(&coupling, scene.engine, &handle, kPeriod_s, force_N, torque_Nm),
        PALPATE_OK);
    const Pose poses[2] = {tool.pose(), {}};
    TickResult r;
    ASSERT_EQ(tick(*engine, poses, {}, r), Status::ok);
    const Wrench w = tool.step(pose_of(i), r.wrench, r.stiffness, kPeriod_s);
    EXPECT_EQ(std::memcmp(force_N, &w.force_N, sizeof force_N), 0);
    EXPECT_EQ(std::memcmp(torque_Nm, &w.torque_Nm, sizeof torque_Nm), 0);
    pushed_N += force_N[0];
  }
  EXPECT_GT(pushed_N, 0);
}

TEST(CInterface, foretells_the_wrench_nearby) {
  CScene scene;
  palpate_pose tool = c_pose_of({{1.35, 0, 0}, {}});
  const palpate_result r = scene.tick(tool);
  ASSERT_GT(r.contacts, 0u);
  double force_N[3], torque_Nm[3];
  ASSERT_EQ(palpate_predict(scene.engine, &tool, force_N, torque_Nm), PALPATE_OK);
  EXPECT_EQ(force_N[0], r.force_N[0]);
  tool.position_m[0] -= 1e-4;
  ASSERT_EQ(palpate_predict(scene.engine, &tool, force_N, torque_Nm), PALPATE_OK);
  EXPECT_GT(force_N[0], r.force_N[0]);
}

TEST(CInterface, friction_and_damping_give_the_same_bits_as_in_cpp) {
  CScene scene;
  const CppScene same;
  const double coefficients[1] = {0.3};
  force::Stick sticks[1];
  force::Friction friction(coefficients, sticks);
  palpate_stick c_sticks[1];
  palpate_release(c_sticks, 1);
  const double linear[3] = {-0.2, 0.1, 0}, angular[3] = {0, 0, 0.5};
  const Vec6 velocity{-0.2, 0.1, 0, 0, 0, 0.5};
  constexpr double kDamping_s = 0.01;

  double along_N = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {{{1.4 - 0.002 * i, 0.003 * i, 0}, {}}, {}};
    const palpate_result before = scene.tick(c_pose_of(poses[0]));
    double force_N[3], torque_Nm[3];
    ASSERT_EQ(palpate_add_friction(scene.engine, coefficients, c_sticks, force_N, torque_Nm),
              PALPATE_OK);
    TickResult r;
    ASSERT_EQ(tick(*same.engine, poses, {}, r), Status::ok);
    friction.add(same.pairs, 0, same.settings, poses, r);
    EXPECT_EQ(std::memcmp(force_N, &r.wrench.force_N, sizeof force_N), 0);
    EXPECT_EQ(std::memcmp(torque_Nm, &r.wrench.torque_Nm, sizeof torque_Nm), 0);
    along_N = std::max(along_N, std::abs(force_N[1] - before.force_N[1]));
    ASSERT_EQ(palpate_damp(scene.engine, linear, angular, kDamping_s, force_N, torque_Nm),
              PALPATE_OK);
    const Wrench damped = force::damped(r.wrench, r.stiffness, velocity, kDamping_s);
    EXPECT_EQ(std::memcmp(force_N, &damped.force_N, sizeof force_N), 0);
    EXPECT_EQ(std::memcmp(torque_Nm, &damped.torque_Nm, sizeof torque_Nm), 0);
  }
  EXPECT_GT(along_N, 1);
}

TEST(CInterface, released_friction_starts_afresh) {
  CScene scene;
  const double coefficients[1] = {0.3};
  palpate_stick sticks[1];
  palpate_release(sticks, 1);
  double force_N[3], torque_Nm[3];
  const auto felt_along = [&](double y_m) {
    scene.tick(c_pose_of({{1.35, y_m, 0}, {}}));
    EXPECT_EQ(palpate_add_friction(scene.engine, coefficients, sticks, force_N, torque_Nm),
              PALPATE_OK);
    return force_N[1];
  };
  const double untouched_N = felt_along(0);
  EXPECT_LT(felt_along(0.001), untouched_N - 0.1);
  palpate_release(sticks, 1);
  EXPECT_NEAR(felt_along(0), untouched_N, 1e-9);
}

TEST(CInterface, refuses_unsound_friction_and_damping) {
  CScene scene;
  scene.tick(c_pose_of({{1.35, 0, 0}, {}}));
  palpate_stick sticks[1];
  palpate_release(sticks, 1);
  palpate_release(nullptr, 1);
  double force_N[3], torque_Nm[3];
  for (const double bad : {-0.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(palpate_add_friction(scene.engine, &bad, sticks, force_N, torque_Nm),
              PALPATE_BAD_ARGUMENT);
    const double still[3] = {0, 0, 0};
    EXPECT_EQ(palpate_damp(scene.engine, still, still, bad, force_N, torque_Nm),
              PALPATE_BAD_ARGUMENT);
    const double velocity[3] = {0, 0, bad};
    EXPECT_EQ(palpate_damp(scene.engine, still, velocity, 0.01, force_N, torque_Nm),
              std::isfinite(bad) ? PALPATE_OK : PALPATE_BAD_ARGUMENT);
  }
  const double coefficient = 0.3;
  EXPECT_EQ(palpate_add_friction(scene.engine, &coefficient, nullptr, force_N, torque_Nm),
            PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_damp(nullptr, nullptr, nullptr, 0, nullptr, nullptr), PALPATE_BAD_ARGUMENT);
}

TEST(CInterface, refuses_unsound_couplings) {
  CScene scene;
  palpate_coupling_settings settings;
  palpate_default_coupling(&settings);
  palpate_coupling coupling;
  palpate_pose pose = c_pose_of({});
  for (double palpate_coupling_settings::*field :
       {&palpate_coupling_settings::spring_N_per_m, &palpate_coupling_settings::inertia_kg_m2}) {
    palpate_coupling_settings bad = settings;
    bad.*field = 0;
    EXPECT_EQ(palpate_couple(&bad, &pose, &coupling), PALPATE_BAD_ARGUMENT);
  }
  EXPECT_EQ(palpate_couple(&settings, nullptr, &coupling), PALPATE_BAD_ARGUMENT);
  ASSERT_EQ(palpate_couple(&settings, &pose, &coupling), PALPATE_OK);
  double force_N[3], torque_Nm[3];
  EXPECT_EQ(palpate_step_coupling(&coupling, scene.engine, &pose, 0, force_N, torque_Nm),
            PALPATE_BAD_ARGUMENT);
  pose.position_m[1] = std::nan("");
  const auto bad_pose = static_cast<palpate_status>(Status::bad_pose);
  EXPECT_EQ(palpate_couple(&settings, &pose, &coupling), bad_pose);
  EXPECT_EQ(palpate_step_coupling(&coupling, scene.engine, &pose, 0.001, force_N, torque_Nm),
            bad_pose);
  EXPECT_EQ(palpate_predict(scene.engine, &pose, force_N, torque_Nm), bad_pose);
}

TEST(CInterface, refuses_what_it_is_not_given) {
  palpate_image image;
  EXPECT_EQ(palpate_open(nullptr, 0, &image), PALPATE_BAD_ARGUMENT);
  const AlignedBytes a = ball();
  EXPECT_EQ(palpate_open(a.data(), a.size(), nullptr), PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_open(a.data(), a.size() - 64, &image),
            static_cast<palpate_status>(Status::image_bad_size));
  EXPECT_STREQ(palpate_describe(PALPATE_OK), "ok");
  palpate_limits limits;
  palpate_default_limits(&limits);
  EXPECT_EQ(palpate_required_bytes(nullptr, &limits, 0), 0u);
  const palpate_scene nothing{};
  EXPECT_EQ(palpate_required_bytes(&nothing, &limits, 0), 0u);
  palpate_settings settings;
  palpate_default_settings(&settings);
  palpate_engine* engine = nullptr;
  EXPECT_EQ(palpate_create(&nothing, &settings, &limits, &image, sizeof image, &engine),
            PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_restore(&nothing, &limits, 0, &image, sizeof image, &engine),
            PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_configure(nullptr, &settings), PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_tick(nullptr, nullptr, nullptr, nullptr), PALPATE_BAD_ARGUMENT);
  EXPECT_EQ(palpate_get_contact(nullptr, 0, nullptr), PALPATE_BAD_ARGUMENT);
}

std::string file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(CInterface, loop_on_the_page_runs) {
  const std::string image = file(PALPATE_TEST_DATA "/bumpy_ball_regions.bin");
  AlignedBytes a(image.size());
  std::memcpy(a.data(), image.data(), image.size());
  const AlignedBytes& b = a;
  g_pushed.clear();
  g_tick = 0;
  EXPECT_EQ(run(a.data(), a.size(), b.data(), b.size()), 0);
  ASSERT_EQ(g_pushed.size(), static_cast<std::size_t>(kTicks));
  EXPECT_EQ(run(a.data(), a.size() - 1, b.data(), b.size()), 1);
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t start = text.find(from) + from.size();
  return text.substr(start, text.find(to, start) - start);
}

TEST(CInterface, page_shows_the_loop_that_is_tested) {
  const std::string code =
      between(file(PALPATE_TESTS "/unit/c_interface_loop.c"), "/* loop */\n", "/* end */");
  EXPECT_NE(file(PALPATE_DOCS "/EMBEDDING.md").find(code), std::string::npos);
}

}  // namespace

}  // namespace palpate::test

extern "C" int read_device(palpate_pose* tool) {
  if (palpate::test::g_tick == palpate::test::kTicks) return 0;
  *tool = palpate::test::c_pose_of(palpate::test::pose_of(palpate::test::g_tick++));
  return 1;
}

extern "C" void push_device(const double force_N[3], const double[3]) {
  palpate::test::g_pushed.push_back({force_N[0], force_N[1], force_N[2]});
}

extern "C" uint64_t cycle_ns(void*) { return 0; }
