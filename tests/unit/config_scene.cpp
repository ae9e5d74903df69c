// SPDX-License-Identifier: Apache-2.0
#include "config/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../support/temporary_folder.hpp"
#include "config/scene_keys.hpp"

namespace palpate::config {
namespace {

const std::string kBodies = R"(
[[body]]
name = "a"
image = "a.palp"
role = "tool"
[[body]]
name = "b"
image = "b.palp"
)";

class ConfigScene : public ::testing::Test {
 protected:
  Scene load(const std::string& text) { return load_scene(folder_.write("scene.toml", text)); }

  /// The message of the refusal, with the folder's name taken out.
  std::string refusal(const std::string& text) {
    try {
      load(text);
    } catch (const ConfigError& e) {
      std::string message = e.what();
      const std::string folder = folder_.path().string() + "/";
      const std::size_t at = message.find(folder);
      if (at != std::string::npos) message.erase(at, folder.size());
      return message;
    }
    return "accepted";
  }

  void expect_refusal(const std::string& text, const std::string& what, const std::string& place,
                      const std::string& fix) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.find(what), 0u) << message;
    EXPECT_NE(message.find(": " + place + ": "), std::string::npos) << message;
    EXPECT_NE(message.find(fix, message.find(place)), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ConfigScene, OnlyBodies_load_defaults) {
  const Scene s = load(kBodies);
  EXPECT_EQ(s.settings.engine, EngineKind::levels);
  EXPECT_EQ(s.settings.delta_m, 0.0005);
  EXPECT_EQ(s.settings.s0, 0.025);
  EXPECT_FALSE(s.settings.exact);
  EXPECT_FALSE(s.budget_us.has_value());
  EXPECT_FALSE(s.reserve_us.has_value());
  EXPECT_EQ(s.settings.max_force_N, 3.0);
  EXPECT_EQ(s.settings.max_torque_Nm, 0.1);
  EXPECT_EQ(s.max_memory_MB, 1000.0);
  EXPECT_EQ(s.rate_Hz, 1000.0);
  EXPECT_EQ(s.coupling, Coupling::direct);
  EXPECT_TRUE(s.passivity_control);
  EXPECT_FALSE(s.device_damping_N_s_per_m.has_value());
  EXPECT_TRUE(s.hand.path.empty());
  ASSERT_EQ(s.bodies.size(), 2u);
  EXPECT_EQ(s.bodies[1].role, Role::fixed);
  EXPECT_EQ(s.bodies[1].pose.orientation.w, 1.0);
}

TEST_F(ConfigScene, EveryKey_lands_in_its_field) {
  const Scene s = load(R"(
[engine]
engine = "regions"
delta_m = 0.001
s0 = 0.05
exact = true
interpolate = true
budget_us = 400
reserve_us = 150
[force]
stiffness_N_per_m = 500.0
cluster_radius_m = 0.004
max_force_N = 2.5
max_torque_Nm = 0.2
coupling = "virtual"
[coupling]
spring_N_per_m = 700.0
spring_Nm_per_rad = 0.5
tool_mass_kg = 0.02
tool_inertia_kg_m2 = 3e-5
[limits]
nodes = 1000
contacts = 100
clusters = 10
max_memory_MB = 64.5
[run]
rate_Hz = 2000
passivity_control = false
device_damping_N_s_per_m = 1.5
[mock]
mass_kg = 0.1
inertia_kg_m2 = 2e-4
grip_N_per_m = 200.0
grip_Nm_per_rad = 0.25
damping_N_s_per_m = 4.0
damping_Nm_s_per_rad = 0.02
[[mock.path]]
t_s = 0.0
position = [1, 2, 3]
[[mock.path]]
t_s = 1.5
position = [0.0, 0.0, -1.0]
orientation = [0.0, 0.0, 1.0, 0.0]
[[body]]
name = "b"
image = "deep/b.palp"
role = "moved"
position = [4.0, 5.0, 6.0]
orientation = [0.6, 0.8, 0.0, 0.0]
[[body]]
name = "a"
image = "/elsewhere/a.palp"
role = "tool"
[[pair]]
a = "b"
b = "a"
)");
  EXPECT_EQ(s.settings.engine, EngineKind::regions);
  EXPECT_EQ(s.settings.delta_m, 0.001);
  EXPECT_EQ(s.settings.s0, 0.05);
  EXPECT_TRUE(s.settings.exact);
  EXPECT_EQ(s.budget_us, 400.0);
  EXPECT_EQ(s.reserve_us, 150.0);
  EXPECT_EQ(s.settings.stiffness_N_per_m, 500.0);
  EXPECT_EQ(s.settings.cluster_radius_m, 0.004);
  EXPECT_EQ(s.settings.max_force_N, 2.5);
  EXPECT_EQ(s.settings.max_torque_Nm, 0.2);
  EXPECT_EQ(s.coupling, Coupling::virtual_);
  EXPECT_EQ(s.virtual_tool.spring_N_per_m, 700.0);
  EXPECT_EQ(s.virtual_tool.spring_Nm_per_rad, 0.5);
  EXPECT_EQ(s.virtual_tool.mass_kg, 0.02);
  EXPECT_EQ(s.virtual_tool.inertia_kg_m2, 3e-5);
  EXPECT_FALSE(s.passivity_control);
  EXPECT_EQ(s.device_damping_N_s_per_m, 1.5);
  EXPECT_EQ(s.limits.nodes, 1000u);
  EXPECT_EQ(s.limits.contacts, 100u);
  EXPECT_EQ(s.limits.clusters, 10u);
  EXPECT_EQ(s.max_memory_MB, 64.5);
  EXPECT_EQ(s.rate_Hz, 2000.0);
  EXPECT_EQ(s.hand.mass_kg, 0.1);
  EXPECT_EQ(s.hand.inertia_kg_m2, 2e-4);
  EXPECT_EQ(s.hand.grip_N_per_m, 200.0);
  EXPECT_EQ(s.hand.grip_Nm_per_rad, 0.25);
  EXPECT_EQ(s.hand.damping_N_s_per_m, 4.0);
  EXPECT_EQ(s.hand.damping_Nm_s_per_rad, 0.02);
  ASSERT_EQ(s.hand.path.size(), 2u);
  EXPECT_EQ(s.hand.path[0].pose.position_m.y, 2.0);
  EXPECT_EQ(s.hand.path[1].t_s, 1.5);
  EXPECT_EQ(s.hand.path[1].pose.orientation.y, 1.0);
  EXPECT_EQ(s.tool, 1u);
  EXPECT_EQ(s.bodies[0].image, folder_.path() / "deep/b.palp");
  EXPECT_EQ(s.bodies[0].role, Role::moved);
  EXPECT_EQ(s.bodies[0].pose.position_m.z, 6.0);
  EXPECT_DOUBLE_EQ(s.bodies[0].pose.orientation.x, 0.8);
  EXPECT_EQ(s.bodies[1].image, "/elsewhere/a.palp");
  ASSERT_EQ(s.pairs.size(), 1u);
  EXPECT_EQ(s.pairs[0].a, 0u);
  EXPECT_EQ(s.pairs[0].b, 1u);
}

TEST_F(ConfigScene, NoPairs_tool_against_every_other) {
  const Scene s = load(kBodies + "[[body]]\nname = \"c\"\nimage = \"c.palp\"\nrole = \"moved\"\n");
  ASSERT_EQ(s.pairs.size(), 2u);
  EXPECT_EQ(s.pairs[0].a, 0u);
  EXPECT_EQ(s.pairs[0].b, 1u);
  EXPECT_EQ(s.pairs[1].a, 0u);
  EXPECT_EQ(s.pairs[1].b, 2u);
}

TEST_F(ConfigScene, Scales_from_nanometres_to_megametres_load) {
  for (const double scale : {1e-9, 1e-6, 1.0, 1e4, 1e6}) {
    const std::string delta = to_text(0.01 * scale), k = to_text(3 / (0.01 * scale));
    const Scene s =
        load("[engine]\ndelta_m = " + delta + "\ns0 = 0.0\n[force]\nstiffness_N_per_m = " + k +
             "\nmax_force_N = 1000000.0\nmax_torque_Nm = 1000000.0\n" + kBodies + "position = [" +
             to_text(scale) + ", 0.0, 0.0]\n");
    EXPECT_EQ(s.settings.delta_m, 0.01 * scale);
    EXPECT_EQ(s.bodies[1].pose.position_m.x, scale);
  }
}

TEST_F(ConfigScene, Quaternion_a_little_off_is_normalised) {
  const Scene s = load(kBodies + "orientation = [1.0005, 0.0, 0.0, 0.0]\n");
  EXPECT_EQ(s.bodies[1].pose.orientation.w, 1.0);
}

TEST_F(ConfigScene, Quaternion_off_or_zero_is_refused) {
  for (const char* q :
       {"[1.002, 0.0, 0.0, 0.0]", "[0.0, 0.0, 0.0, 0.0]", "[0.99, 0.0, 0.0, 0.0]"}) {
    const std::string message = refusal(kBodies + "orientation = " + q + "\n");
    EXPECT_NE(message.find("scene.toml:9: "), std::string::npos) << message;
  }
  expect_refusal(kBodies + "orientation = [nan, 0.0, 0.0, 0.0]\n", "[[body]] orientation = nan",
                 "scene.toml:9", "number");
}

// Every key of the table, by the table: a wrong type and the numbers just outside the range.

template <class T>
std::vector<std::string> wrong_values(const Real<T>& v) {
  const double below = v.min == 0 ? -1e-300 : v.min * 0.99;
  return {"\"1\"", "true", "nan", "inf", "-inf", to_text(below), to_text(v.max * 1.01)};
}
template <class T>
std::vector<std::string> wrong_values(const OptionalReal<T>& v) {
  return wrong_values(Real<T>{nullptr, v.min, v.max});
}
template <class T>
std::vector<std::string> wrong_values(const Count<T>& v) {
  return {"\"1\"", "1.5", "-1", std::to_string(v.min - 1),
          std::to_string(std::uint64_t(v.max) + 1)};
}
template <class T>
std::vector<std::string> wrong_values(const Flag<T>&) {
  return {"1", "\"true\""};
}
template <class T>
std::vector<std::string> wrong_values(const Choice<T>&) {
  return {"1", "\"\"", "\"nothing\""};
}

TEST_F(ConfigScene, EveryKey_with_wrong_value_is_refused_with_line_and_range) {
  for (const Table<Scene>& table : tables()) {
    for (const Key<Scene>& key : table.keys) {
      const auto values = std::visit(
          [](const auto& v) {
            if constexpr (requires { wrong_values(v); }) {
              return wrong_values(v);
            } else {
              return std::vector<std::string>{};
            }
          },
          key.value);
      ASSERT_FALSE(values.empty()) << key.name;
      for (const std::string& value : values) {
        const std::string name = std::string(table.name) + " " + std::string(key.name);
        SCOPED_TRACE(name + " = " + value);
        expect_refusal(
            std::string(table.name) + "\n" + std::string(key.name) + " = " + value + "\n" + kBodies,
            name, "scene.toml:2",
            std::holds_alternative<Choice<Scene>>(key.value) ? "one of" : "give ");
      }
    }
  }
}

TEST_F(ConfigScene, Positions_that_are_none_are_refused) {
  for (const char* p : {"1.0", "[1.0, 2.0]", "[1.0, 2.0, 3.0, 4.0]", "[1.0, \"2\", 3.0]",
                        "[0.0, inf, 0.0]", "[2e12, 0.0, 0.0]"}) {
    const std::string message = refusal(kBodies + "position = " + p + "\n");
    EXPECT_EQ(message.find("[[body]] position"), 0u) << message;
    EXPECT_NE(message.find("scene.toml:9: give "), std::string::npos) << message;
  }
}

TEST_F(ConfigScene, UnknownKey_names_line_and_nearest) {
  expect_refusal("[engine]\n\ndelta = 0.1\n" + kBodies, "unknown key 'delta' in [engine]",
                 "scene.toml:3", "did you mean 'delta_m'? use one of engine, delta_m, s0, ");
  expect_refusal("[force]\nstifness_N_per_m = 1\n" + kBodies, "unknown key 'stifness_N_per_m'",
                 "scene.toml:2", "did you mean 'stiffness_N_per_m'?");
  expect_refusal(kBodies + "colour = 1\n", "unknown key 'colour' in [[body]]", "scene.toml:9",
                 "use one of name, image");
  expect_refusal("[mock]\nwaypoints = []\n" + kBodies, "unknown key 'waypoints' in [mock]",
                 "scene.toml:2", "path");
}

TEST_F(ConfigScene, UnknownTable_names_line_and_nearest) {
  expect_refusal("[forces]\n" + kBodies, "unknown table 'forces'", "scene.toml:1",
                 "did you mean 'force'?");
  expect_refusal("delta_m = 1.0\n" + kBodies, "unknown key 'delta_m'", "scene.toml:1",
                 "use one of engine, force");
  expect_refusal("engine = \"levels\"\n" + kBodies, "'engine' is no table", "scene.toml:1",
                 "[engine]");
  expect_refusal("body = 3\n", "'body' is no array of tables", "scene.toml:1", "[[body]]");
  expect_refusal("body = [1]\n", "'body' is no array of tables", "scene.toml:1", "[[body]]");
}

TEST_F(ConfigScene, Body_mistakes_are_refused) {
  expect_refusal("", "no body is the tool", "scene.toml:1", "[[body]]");
  expect_refusal("[[body]]\nname = \"a\"\nimage = \"a\"\nrole = \"tool\"\n", "only one body",
                 "scene.toml:1", "[[body]]");
  expect_refusal(kBodies + "role = \"tool\"\n", "a second tool", "scene.toml:6", "role");
  expect_refusal(kBodies + "role = \"tol\"\n", "[[body]] role = 'tol' is unknown", "scene.toml:9",
                 "did you mean 'tool'?");
  expect_refusal(kBodies + "[[body]]\nname = \"a\"\nimage = \"c\"\n", "a second body named 'a'",
                 "scene.toml:10", "own name");
  expect_refusal(kBodies + "[[body]]\nimage = \"c\"\n", "missing key 'name' in [[body]]",
                 "scene.toml:9", "add name");
  expect_refusal(kBodies + "[[body]]\nname = \"c\"\n", "missing key 'image' in [[body]]",
                 "scene.toml:9", "add image");
  expect_refusal(kBodies + "[[body]]\nname = \"\"\nimage = \"c\"\n", "[[body]] name is empty",
                 "scene.toml:10", "text");
  expect_refusal(kBodies + "[[body]]\nname = \"c,d\"\nimage = \"c\"\n", "[[body]] name 'c,d'",
                 "scene.toml:10", "letters");
  expect_refusal(kBodies + "[[body]]\nname = 3\nimage = \"c\"\n", "[[body]] name is of type",
                 "scene.toml:10", "text");
}

TEST_F(ConfigScene, TooManyBodies_are_refused) {
  std::string text = kBodies;
  for (std::uint32_t i = 2; i <= kMaxBodies; ++i)
    text += "[[body]]\nname = \"x" + std::to_string(i) + "\"\nimage = \"x\"\n";
  expect_refusal(text, "too many bodies", "scene.toml:195", "64");
}

TEST_F(ConfigScene, Pair_mistakes_are_refused) {
  expect_refusal(kBodies + "[[pair]]\na = \"a\"\nb = \"c\"\n", "no body is named 'c'",
                 "scene.toml:11", "use one of a, b");
  expect_refusal(kBodies + "[[pair]]\na = \"a\"\nb = \"a\"\n", "[[pair]] of a body with itself",
                 "scene.toml:9", "two");
  expect_refusal(kBodies + "[[pair]]\na = \"a\"\n", "missing key 'b' in [[pair]]", "scene.toml:9",
                 "add b");
  expect_refusal(kBodies + "[[pair]]\na = \"a\"\nb = \"b\"\n[[pair]]\na = \"b\"\nb = \"a\"\n",
                 "[[pair]] of 'b' and 'a'", "scene.toml:12", "remove");
}

TEST_F(ConfigScene, Path_mistakes_are_refused) {
  const std::string point = "position = [0.0, 0.0, 0.0]\n";
  const auto path = [&](const std::string& a, const std::string& b) {
    return "[[mock.path]]\nt_s = " + a + "\n" + point + "[[mock.path]]\nt_s = " + b + "\n" + point +
           kBodies;
  };
  expect_refusal(path("0.5", "1.0"), "[[mock.path]] t_s = 0.5 is out of order", "scene.toml:2",
                 "start the path at 0");
  expect_refusal(path("0", "0"), "[[mock.path]] t_s = 0 is out of order", "scene.toml:5",
                 "after 0");
  expect_refusal("[[mock.path]]\nt_s = 0\n" + kBodies, "missing key 'position'", "scene.toml:1",
                 "add position");
  expect_refusal("[mock]\npath = 1\n" + kBodies, "'path' is no array of tables", "scene.toml:2",
                 "[[mock.path]]");
}

TEST_F(ConfigScene, Text_that_is_not_toml_is_refused_with_line) {
  expect_refusal(kBodies + "position = [0.0, \n\n", "not TOML (", "scene.toml:10", "fix");
  expect_refusal("[engine]\ns0 = 1\ns0 = 2\n" + kBodies, "not TOML (", "scene.toml:3", "fix");
  expect_refusal(std::string("\xff\xfe\x00", 3), "not TOML (", "scene.toml:1", "fix");
}

TEST_F(ConfigScene, Unreadable_file_is_refused) {
  EXPECT_THROW(load_scene(folder_.path() / "absent.toml"), ConfigError);
  EXPECT_THROW(load_scene(folder_.path()), ConfigError);
}

}  // namespace
}  // namespace palpate::config
