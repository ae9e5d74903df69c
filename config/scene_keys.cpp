// SPDX-License-Identifier: Apache-2.0
#include "config/scene_keys.hpp"

#include <charconv>

namespace palpate::config {
namespace {

// Ranges are wide on purpose: parts of a micrometre and terrains of kilometres are scenes too. They
// catch slips of sign and unit, and numbers whose squares would leave the range of double.
constexpr double kLeast = 1e-18;
constexpr double kMost = 1e18;

constexpr std::string_view kEngines[] = {"levels", "regions"};
constexpr std::string_view kBounds[] = {"tight", "paper"};
constexpr std::string_view kOrders[] = {"deviation", "force"};
constexpr std::string_view kCouplings[] = {"direct", "virtual"};
constexpr std::string_view kRoles[] = {"tool", "moved", "fixed"};

constexpr Key<Scene> kEngineKeys[] = {
    {"engine", "",
     Choice<Scene>{kEngines,
                   [](Scene& s, std::size_t i) { s.settings.engine = static_cast<EngineKind>(i); },
                   [](const Scene& s) { return static_cast<std::size_t>(s.settings.engine); }},
     "the contact query: `levels` refines convex pieces, `regions` regions of the tool's surface"},
    {"delta_m", "m",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.delta_m; }, kLeast, kMost},
     "contact tolerance: features nearer than this are contacts"},
    {"s0", "1", Real<Scene>{[](Scene& s) -> double& { return s.settings.s0; }, 0, 1e6},
     "detail felt less than this is left out; relative to the radius of the body that loses it"},
    {"kappa", "1",
     OptionalReal<Scene>{[](Scene& s) -> std::optional<double>& { return s.kappa; }, 0, 1e6},
     "surfaces deviating by more than this share of `delta_m` are refined, whatever `s0` says; "
     "absent: `s0` alone decides"},
    {"exact", "", Flag<Scene>{[](Scene& s) -> bool& { return s.settings.exact; }},
     "prove the force; `levels`: and refine everything nearer than `delta_m` to the original "
     "surface, whatever `s0` says"},
    {"force_tolerance_N", "N",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.force_tolerance_N; }, 0, kMost},
     "`regions`: refinement ends once the certified error of the force is no more and it is known "
     "which bodies touch"},
    {"interpolate", "", Flag<Scene>{[](Scene& s) -> bool& { return s.interpolate; }},
     "has no effect any more, and is read so that older scenes can be: the least push needs no "
     "blending between levels (Sec. 5.5 of the paper)"},
    {"bounds", "",
     Choice<Scene>{kBounds,
                   [](Scene& s, std::size_t i) { s.settings.bounds = static_cast<Bounds>(i); },
                   [](const Scene& s) { return static_cast<std::size_t>(s.settings.bounds); }},
     "what culls pairs of pieces: `tight` hulls of the original surface below them, or the "
     "`paper`'s, their own hulls widened"},
    {"order", "",
     Choice<Scene>{kOrders,
                   [](Scene& s, std::size_t i) { s.settings.order = static_cast<Order>(i); },
                   [](const Scene& s) { return static_cast<std::size_t>(s.settings.order); }},
     "what is refined first under a budget: the largest weighted surface `deviation` (the paper's "
     "order), or what can still change the `force` most"},
    {"budget_us", "µs",
     OptionalReal<Scene>{[](Scene& s) -> std::optional<double>& { return s.budget_us; }, 0, 1e9},
     "time after which one tick stops refining; absent: unlimited in replay, chosen from the rate "
     "in run"},
    {"reserve_us", "µs",
     OptionalReal<Scene>{[](Scene& s) -> std::optional<double>& { return s.reserve_us; }, 0, 1e9},
     "`regions`: so much longer than `budget_us` for a tick that feels nothing and cannot rule out "
     "a contact, until it can; absent: none in replay, what the rate leaves in run"},
};

constexpr Key<Scene> kForceKeys[] = {
    {"stiffness_N_per_m", "N/m",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.stiffness_N_per_m; }, 0, kMost},
     "of the force in any one direction, however many contacts push that way"},
    {"cluster_radius_m", "m",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.cluster_radius_m; }, 0, kMost},
     "contacts nearer together than this count as one where the force is shared out"},
    {"max_force_N", "N",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.max_force_N; }, 0, kMost},
     "the force on the tool is scaled down to this length"},
    {"max_torque_Nm", "N m",
     Real<Scene>{[](Scene& s) -> double& { return s.settings.max_torque_Nm; }, 0, kMost},
     "the torque on the tool is scaled down to this length"},
    {"steady_force_N_per_s", "N/s",
     Real<Scene>{[](Scene& s) -> double& { return s.steady_force_N_per_s; }, 0, kMost},
     "`palpate run`, coupled directly: what the stiffness does not make of the tool's motion, "
     "such as a change of level or of budget, changes the force no faster"},
    {"steady_torque_Nm_per_s", "N m/s",
     Real<Scene>{[](Scene& s) -> double& { return s.steady_torque_Nm_per_s; }, 0, kMost},
     "the same of the torque"},
    {"max_force_slew_N_per_s", "N/s",
     Real<Scene>{[](Scene& s) -> double& { return s.max_force_slew_N_per_s; }, 0, kMost},
     "`palpate run`: the force that is sent changes no faster"},
    {"max_torque_slew_Nm_per_s", "N m/s",
     Real<Scene>{[](Scene& s) -> double& { return s.max_torque_slew_Nm_per_s; }, 0, kMost},
     "the same of the torque"},
    {"max_power_W", "W", Real<Scene>{[](Scene& s) -> double& { return s.max_power_W; }, 0, kMost},
     "`palpate run`: the wrench is scaled down where it would give the hand more; it goes before "
     "the "
     "slew"},
    {"contact_damping_N_s_per_m", "N s/m",
     Real<Scene>{[](Scene& s) -> double& { return s.contact_damping_N_s_per_m; }, 0, kMost},
     "contacts resist velocity too, in any one direction, with at most their force"},
    {"coupling", "",
     Choice<Scene>{kCouplings,
                   [](Scene& s, std::size_t i) { s.coupling = static_cast<Coupling>(i); },
                   [](const Scene& s) { return static_cast<std::size_t>(s.coupling); }},
     "`palpate run`: the hand feels the contacts, `direct`, or a spring to a simulated tool that "
     "feels them, `virtual`, which is stable however stiff they are"},
};

constexpr Key<Scene> kCouplingKeys[] = {
    {"spring_N_per_m", "N/m",
     Real<Scene>{[](Scene& s) -> double& { return s.virtual_tool.spring_N_per_m; }, kLeast, kMost},
     "between hand and simulated tool; its damper is critical"},
    {"spring_Nm_per_rad", "N m/rad",
     Real<Scene>{[](Scene& s) -> double& { return s.virtual_tool.spring_Nm_per_rad; }, kLeast,
                 kMost},
     "the same about the tool's origin"},
    {"tool_mass_kg", "kg",
     Real<Scene>{[](Scene& s) -> double& { return s.virtual_tool.mass_kg; }, kLeast, kMost},
     "of the simulated tool"},
    {"tool_inertia_kg_m2", "kg m²",
     Real<Scene>{[](Scene& s) -> double& { return s.virtual_tool.inertia_kg_m2; }, kLeast, kMost},
     "moment of inertia of the same about every axis"},
};

constexpr Key<Scene> kLimitKeys[] = {
    {"nodes", "",
     Count<Scene>{[](Scene& s) -> std::uint32_t& { return s.limits.nodes; }, 1, 1u << 26},
     "room for nodes of the bounding volume test tree, over all pairs"},
    {"contacts", "",
     Count<Scene>{[](Scene& s) -> std::uint32_t& { return s.limits.contacts; }, 1, 1u << 24},
     "room for contacts of one tick, over all pairs"},
    {"clusters", "",
     Count<Scene>{[](Scene& s) -> std::uint32_t& { return s.limits.clusters; }, 1, 1u << 16},
     "room for grid points of `cluster_radius_m` near contacts of one tick, over all pairs"},
    {"max_memory_MB", "MB",
     Real<Scene>{[](Scene& s) -> double& { return s.max_memory_MB; }, 0.001, 1e6},
     "images and engine together may take this much memory (1 MB = 10^6 bytes); a scene that needs "
     "more is refused"},
};

constexpr Key<Scene> kRunKeys[] = {
    {"rate_Hz", "Hz", Real<Scene>{[](Scene& s) -> double& { return s.rate_Hz; }, 1, 20000},
     "rate of the real-time loop"},
    {"contact_rate_Hz", "Hz",
     OptionalReal<Scene>{[](Scene& s) -> std::optional<double>& { return s.contact_rate_Hz; }, 1,
                         20000},
     "contacts are asked for at this rate, on a thread of their own, and the loop renders their "
     "linear model between; absent: every tick asks"},
    {"passivity_control", "", Flag<Scene>{[](Scene& s) -> bool& { return s.passivity_control; }},
     "a damper takes back the energy that the loop has given out of its own"},
    {"device_damping_N_s_per_m", "N s/m",
     OptionalReal<Scene>{
         [](Scene& s) -> std::optional<double>& { return s.device_damping_N_s_per_m; }, 0, kMost},
     "of the device and the hand that holds it: a stiffness too large for it is lowered; absent: "
     "the mock hand's, unknown for other devices"},
};

constexpr Key<Scene> kMockKeys[] = {
    {"mass_kg", "kg",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.mass_kg; }, kLeast, kMost},
     "of the hand and the tool in it"},
    {"inertia_kg_m2", "kg m²",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.inertia_kg_m2; }, kLeast, kMost},
     "moment of inertia of the same about every axis"},
    {"grip_N_per_m", "N/m",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.grip_N_per_m; }, 0, kMost},
     "spring from the path to the hand"},
    {"grip_Nm_per_rad", "N m/rad",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.grip_Nm_per_rad; }, 0, kMost},
     "the same about the tool's origin"},
    {"damping_N_s_per_m", "N s/m",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.damping_N_s_per_m; }, 0, kMost},
     "damper beside the spring"},
    {"damping_Nm_s_per_rad", "N m s/rad",
     Real<Scene>{[](Scene& s) -> double& { return s.hand.damping_Nm_s_per_rad; }, 0, kMost},
     "the same about the tool's origin"},
};

constexpr Key<Waypoint> kWaypointKeys[] = {
    {"t_s", "s", Real<Waypoint>{[](Waypoint& w) -> double& { return w.t_s; }, 0, 1e9},
     "time since the start of the path; the first is 0, then ascending", true},
    {"position", "m", Position<Waypoint>{[](Waypoint& w) -> Vec3d& { return w.pose.position_m; }},
     "where the hand wants the tool's origin, in world axes", true},
    {"orientation", "",
     Orientation<Waypoint>{[](Waypoint& w) -> Quat& { return w.pose.orientation; }},
     "unit quaternion w x y z, tool to world"},
};

constexpr Key<Body> kBodyKeys[] = {
    {"name", "", Text<Body>{[](Body& b, const std::string& text) { b.name = text; }},
     "as pairs and pose files call it; every body has its own", true},
    {"image", "", Text<Body>{[](Body& b, const std::string& text) { b.image = text; }},
     "file made by `palpate bake`, relative to the scene file", true},
    {"role", "",
     Choice<Body>{kRoles, [](Body& b, std::size_t i) { b.role = static_cast<Role>(i); },
                  [](const Body& b) { return static_cast<std::size_t>(b.role); }},
     "`tool`: held by the device, exactly one; `moved`: moved by pose files; `fixed`: stays where "
     "it is"},
    {"position", "m", Position<Body>{[](Body& b) -> Vec3d& { return b.pose.position_m; }},
     "of the body's origin in world axes, until something moves it"},
    {"orientation", "", Orientation<Body>{[](Body& b) -> Quat& { return b.pose.orientation; }},
     "unit quaternion w x y z, body to world, until something moves it"},
};

constexpr Key<PairNames> kPairKeys[] = {
    {"a", "", Text<PairNames>{[](PairNames& p, const std::string& text) { p.a = text; }},
     "name of a body; normals point towards it", true},
    {"b", "", Text<PairNames>{[](PairNames& p, const std::string& text) { p.b = text; }},
     "name of another body", true},
    {"friction", "1", Real<PairNames>{[](PairNames& p) -> double& { return p.friction; }, 0, 1e6},
     "coefficient of Coulomb friction, with stick, where one of them is the tool"},
};

constexpr Table<Scene> kTables[] = {
    {"[engine]", kEngineKeys, "How contacts are found."},
    {"[force]", kForceKeys, "How contacts become a force."},
    {"[coupling]", kCouplingKeys, "The simulated tool of `coupling = \"virtual\"`."},
    {"[limits]", kLimitKeys,
     "Capacities. More room takes more memory, never more time. Where one is used up a tick still "
     "answers, truncated; a replay without a budget takes more, up to `max_memory_MB`."},
    {"[run]", kRunKeys, "The real-time loop."},
    {"[mock]", kMockKeys,
     "The mock device: a simulated hand, a mass held to a path by a spring and a damper; with "
     "`--device mouse` the mouse leads it in the path's place."},
};
constexpr Table<Waypoint> kWaypointTable = {
    "[[mock.path]]", kWaypointKeys,
    "One point of the path, any number of them; between two the hand goes straight, after the last "
    "it starts over."};
constexpr Table<Body> kBodyTable = {"[[body]]", kBodyKeys, "One body, 2 to 64 of them."};
constexpr Table<PairNames> kPairTable = {
    "[[pair]]", kPairKeys,
    "Two bodies that may touch, up to 256 pairs. None: the tool against every other body."};

// Markdown of one value: its range and its default.
struct Columns {
  std::string range, fallback;
};

std::string interval(double min, double max) { return to_text(min) + " to " + to_text(max); }

template <class T>
Columns columns(const Real<T>& v) {
  T defaults{};
  return {interval(v.min, v.max), to_text(v.at(defaults))};
}
template <class T>
Columns columns(const OptionalReal<T>& v) {
  return {interval(v.min, v.max), "absent"};
}
template <class T>
Columns columns(const Count<T>& v) {
  T defaults{};
  return {std::to_string(v.min) + " to " + std::to_string(v.max), std::to_string(v.at(defaults))};
}
template <class T>
Columns columns(const Flag<T>& v) {
  T defaults{};
  return {"`true`, `false`", v.at(defaults) ? "`true`" : "`false`"};
}
template <class T>
Columns columns(const Choice<T>& v) {
  std::string range;
  for (const std::string_view word : v.words) {
    range += (range.empty() ? "`\"" : ", `\"") + std::string(word) + "\"`";
  }
  return {range, "`\"" + std::string(v.words[v.get(T{})]) + "\"`"};
}
template <class T>
Columns columns(const Text<T>&) {
  return {"text", ""};
}
template <class T>
Columns columns(const Position<T>&) {
  return {"3 numbers, -" + to_text(kMaxPosition_m) + " to " + to_text(kMaxPosition_m),
          "`[0, 0, 0]`"};
}
template <class T>
Columns columns(const Orientation<T>&) {
  return {"4 numbers, length 1 within 0.001", "`[1, 0, 0, 0]`"};
}

template <class T>
std::string markdown(const Table<T>& table) {
  std::string text =
      "### `" + std::string(table.name) + "`\n\n" + std::string(table.meaning) +
      "\n\n| key | unit | range | default | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const Key<T>& key : table.keys) {
    const Columns c = std::visit([](const auto& v) { return columns(v); }, key.value);
    text += "| `" + std::string(key.name) + "` | " + std::string(key.unit) + " | " + c.range +
            " | " + (key.required ? "required" : c.fallback) + " | " + std::string(key.meaning) +
            " |\n";
  }
  return text;
}

}  // namespace

std::span<const Table<Scene>> tables() { return kTables; }
const Table<Waypoint>& waypoint_table() { return kWaypointTable; }
const Table<Body>& body_table() { return kBodyTable; }
const Table<PairNames>& pair_table() { return kPairTable; }

std::string to_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string key_tables() {
  std::string text;
  for (const Table<Scene>& table : kTables) text += markdown(table) + "\n";
  return text + markdown(kWaypointTable) + "\n" + markdown(kBodyTable) + "\n" +
         markdown(kPairTable);
}

}  // namespace palpate::config
