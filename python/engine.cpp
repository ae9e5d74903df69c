// SPDX-License-Identifier: Apache-2.0
#include "engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <string>

namespace palpate::python {
namespace {

struct Number {
  const char* name;
  double palpate_settings::*at;
};
constexpr Number kNumbers[] = {{"delta_m", &palpate_settings::delta_m},
                               {"s0", &palpate_settings::s0},
                               {"kappa", &palpate_settings::kappa},
                               {"force_tolerance_N", &palpate_settings::force_tolerance_N},
                               {"stiffness_N_per_m", &palpate_settings::stiffness_N_per_m},
                               {"cluster_radius_m", &palpate_settings::cluster_radius_m},
                               {"max_force_N", &palpate_settings::max_force_N},
                               {"max_torque_Nm", &palpate_settings::max_torque_Nm}};

/// A setting with a word for 0 and one for 1.
struct Choice {
  const char* name;
  std::uint32_t palpate_settings::*at;
  const char* words[2];
};
constexpr Choice kChoices[] = {{"engine", &palpate_settings::engine, {"levels", "regions"}},
                               {"bounds", &palpate_settings::bounds, {"tight", "paper"}},
                               {"order", &palpate_settings::order, {"deviation", "force"}}};

struct Flag {
  const char* name;
  std::uint32_t palpate_settings::*at;
};
constexpr Flag kFlags[] = {{"exact", &palpate_settings::exact}};

bool set_one(palpate_settings& to, const std::string& name, const py::handle& value) {
  for (const Number& n : kNumbers) {
    if (name != n.name) continue;
    to.*n.at = value.cast<double>();
    return true;
  }
  for (const Flag& f : kFlags) {
    if (name != f.name) continue;
    to.*f.at = value.cast<bool>() ? 1 : 0;
    return true;
  }
  for (const Choice& c : kChoices) {
    if (name != c.name) continue;
    const auto word = value.cast<std::string>();
    if (word != c.words[0] && word != c.words[1]) {
      throw Refused(name + ": no such choice as '" + word + "': give '" + c.words[0] + "' or '" +
                    c.words[1] + "'");
    }
    to.*c.at = word == c.words[1] ? 1 : 0;
    return true;
  }
  return false;
}

std::string setting_names() {
  std::string all;
  for (const Choice& c : kChoices) all += std::string(c.name) + ", ";
  for (const Flag& f : kFlags) all += std::string(f.name) + ", ";
  for (const Number& n : kNumbers) all += std::string(n.name) + ", ";
  return all.substr(0, all.size() - 2);
}

void set_all(palpate_settings& to, const py::kwargs& from) {
  for (const auto& [key, value] : from) {
    const auto name = key.cast<std::string>();
    if (!set_one(to, name, value)) {
      throw py::type_error("no such setting as '" + name + "': there are " + setting_names());
    }
  }
}

palpate_limits limits_of(const py::dict& from) {
  palpate_limits limits;
  palpate_default_limits(&limits);
  for (const auto& [key, value] : from) {
    const auto name = key.cast<std::string>();
    if (name == "nodes") {
      limits.nodes = value.cast<std::uint32_t>();
    } else if (name == "contacts") {
      limits.contacts = value.cast<std::uint32_t>();
    } else if (name == "clusters") {
      limits.clusters = value.cast<std::uint32_t>();
    } else {
      throw py::type_error("no such limit as '" + name +
                           "': there are nodes, contacts and clusters");
    }
  }
  return limits;
}

void check(palpate_status status, const char* what, const char* cure) {
  if (status == PALPATE_OK) return;
  throw Refused(std::string(what) + ": " + palpate_describe(status) + ": " + cure);
}

std::uint64_t now_ns(void*) {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
}

/// Microseconds, at most what a clock of nanoseconds can hold. Throws for what is no time.
std::uint64_t nanoseconds(double us, const char* name) {
  if (!(us >= 0)) throw Refused(std::string(name) + ": not a time: give microseconds, 0 or more");
  return static_cast<std::uint64_t>(std::min(us, 1e15) * 1e3);
}

palpate_budget budget_of(const Spending& from) {
  palpate_budget budget{};
  budget.units = from.units.value_or(std::numeric_limits<std::uint64_t>::max());
  budget.reserve_units = from.reserve_units;
  budget.reserve_ns = nanoseconds(from.reserve_us, "reserve_us");
  if (from.budget_us) {
    budget.clock_ns = now_ns;
    budget.deadline_ns = now_ns(nullptr) + nanoseconds(*from.budget_us, "budget_us");
  }
  return budget;
}

constexpr std::align_val_t kAlignment{64};
void free_memory(void* memory) { ::operator delete(memory, kAlignment); }

constexpr const char* kSettingsCure =
    "see the ranges of config/README.md, and whether an image was baked for less";

}  // namespace

Engine::Engine(std::vector<std::shared_ptr<Image>> images, const std::optional<Pairs>& pairs,
               std::uint32_t tool, const py::dict& limits, const py::kwargs& settings)
    : kept_(std::move(images)), memory_(nullptr, free_memory) {
  for (const auto& image : kept_) {
    if (image == nullptr) throw Refused("images: None among them: give palpate.Image objects");
    images_.push_back(image->view());
  }
  if (pairs) {
    for (const auto& [a, b] : *pairs) pairs_.push_back({a, b});
  } else {
    for (std::uint32_t body = 0; body < images_.size(); ++body) {
      if (body != tool) pairs_.push_back({tool, body});
    }
  }
  scene_ = {images_.data(), static_cast<std::uint32_t>(images_.size()), pairs_.data(),
            static_cast<std::uint32_t>(pairs_.size()), tool};
  palpate_default_settings(&settings_);
  set_all(settings_, settings);
  const palpate_limits room = limits_of(limits);
  size_ = palpate_required_bytes(&scene_, &room, settings_.engine);
  if (size_ == 0) {
    throw Refused(
        "scene: out of range: give 2 to 64 images, 1 to 256 pairs of two of them, a tool that is "
        "one of them, and limits above 0");
  }
  memory_.reset(::operator new(size_, kAlignment));
  check(palpate_create(&scene_, &settings_, &room, memory_.get(), size_, &engine_), "engine",
        kSettingsCure);
}

void Engine::configure(const py::kwargs& settings) {
  palpate_settings changed = settings_;
  set_all(changed, settings);
  if (changed.engine != settings_.engine) {
    throw Refused("engine: fixed when it is made: make another Engine");
  }
  const std::lock_guard lock(one_at_a_time_);
  check(palpate_configure(engine_, &changed), "settings", kSettingsCure);
  settings_ = changed;
}

py::dict Engine::settings() const {
  py::dict out;
  for (const Choice& c : kChoices) out[c.name] = c.words[settings_.*c.at];
  for (const Flag& f : kFlags) out[f.name] = settings_.*f.at != 0;
  for (const Number& n : kNumbers) out[n.name] = settings_.*n.at;
  return out;
}

/// Without the interpreter's lock, so without anything of Python's.
void Engine::tick_one(const palpate_pose* poses, const Spending& spending, const std::string& name,
                      palpate_result& out) {
  const palpate_budget budget = budget_of(spending);
  const palpate_status status = palpate_tick(engine_, poses, &budget, &out);
  if (status == PALPATE_OK) {
    last_contacts_ = out.contacts;
    return;
  }
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const std::string fault = fault_of(poses[i], name + "[" + std::to_string(i) + "]");
    if (!fault.empty()) throw Refused(fault);
  }
  throw Refused(name + ": " + palpate_describe(status) + ": check the poses and the budget");
}

palpate_result Engine::tick(const Poses& poses, const Spending& spending) {
  const palpate_pose* at = poses_in(poses, 2, images_.size());
  const py::gil_scoped_release others_run;
  const std::lock_guard lock(one_at_a_time_);
  palpate_result out{};
  tick_one(at, spending, "poses", out);
  return out;
}

py::array_t<palpate_result> Engine::ticks(const Poses& poses, const Spending& spending) {
  const palpate_pose* at = poses_in(poses, 3, images_.size());
  const py::ssize_t count = poses.shape(0);
  py::array_t<palpate_result> results(count);
  palpate_result* const out = results.mutable_data();
  const py::gil_scoped_release others_run;
  const std::lock_guard lock(one_at_a_time_);
  for (py::ssize_t i = 0; i < count; ++i) {
    tick_one(at + i * static_cast<py::ssize_t>(images_.size()), spending,
             "poses[" + std::to_string(i) + "]", out[i]);
  }
  return results;
}

py::array_t<palpate_contact> Engine::contacts() const {
  const std::lock_guard lock(one_at_a_time_);
  py::array_t<palpate_contact> found(static_cast<py::ssize_t>(last_contacts_));
  palpate_contact* const out = found.mutable_data();
  for (std::uint32_t i = 0; i < last_contacts_; ++i) {
    check(palpate_get_contact(engine_, i, out + i), "contacts", "tick again");
  }
  return found;
}

py::tuple Engine::predict(const Poses& tool) const {
  if (tool.ndim() != 1 || tool.shape(0) != kPoseNumbers) {
    throw Refused("tool: give one pose, 7 numbers px py pz qw qx qy qz");
  }
  const auto* pose = static_cast<const palpate_pose*>(static_cast<const void*>(tool.data()));
  const std::string fault = fault_of(*pose, "tool");
  if (!fault.empty()) throw Refused(fault);
  py::array_t<double> force(3), torque(3);
  const std::lock_guard lock(one_at_a_time_);
  check(palpate_predict(engine_, pose, force.mutable_data(), torque.mutable_data()), "tool",
        "give a pose near the last tick's");
  return py::make_tuple(force, torque);
}

}  // namespace palpate::python
