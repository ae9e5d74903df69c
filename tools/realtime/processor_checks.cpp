// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/processor_checks.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include "tools/realtime/host_files.hpp"

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCpus = "sys/devices/system/cpu";
constexpr const char* kNone = "no processor is isolated";

/// What a kernel parameter was set to at boot; empty where it was not.
std::string boot_parameter(const fs::path& root, const std::string& name) {
  std::istringstream words(first_line(root / "proc/cmdline").value_or(""));
  const std::string key = name + "=";
  for (std::string word; words >> word;) {
    if (word.rfind(key, 0) == 0) return word.substr(key.size());
  }
  return "";
}

bool includes(const std::set<int>& all, const std::set<int>& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

/// Keeps the last processor for the loop.
std::string boot_advice(const std::set<int>& online) {
  const int last = online.empty() ? 1 : *online.rbegin();
  const std::string cpu = std::to_string(last);
  const std::string others = last == 1 ? "0" : "0-" + std::to_string(last - 1);
  return "boot with the kernel parameters: isolcpus=" + cpu + " nohz_full=" + cpu +
         " rcu_nocbs=" + cpu + " irqaffinity=" + others + ", then palpate run --cpu " + cpu;
}

HostCheck isolated_cpus(const fs::path& root, const std::set<int>& online) {
  const std::string found = first_line(root / kCpus / "isolated").value_or("");
  // Where there is one only, nothing can be changed.
  if (online.size() == 1) {
    return make_check("isolated_cpus", true, "this host has one processor: none can be isolated",
                      "one processor for the loop", "");
  }
  return make_check("isolated_cpus", !found.empty(), found.empty() ? "none" : found,
                    "one processor for the loop", boot_advice(online));
}

HostCheck tickless_cpus(const fs::path& root, const std::set<int>& isolated,
                        const std::string& fix) {
  const std::string found = first_line(root / kCpus / "nohz_full").value_or("");
  const std::set<int> tickless = processors_in(found);
  return make_check("tickless_cpus", includes(tickless, isolated),
                    isolated.empty()   ? kNone
                    : tickless.empty() ? "none"
                                       : found,
                    "no periodic tick on an isolated processor (nohz_full)", fix);
}

/// Processors without a tick have their callbacks moved too.
HostCheck rcu_callbacks(const fs::path& root, const std::set<int>& isolated,
                        const std::string& fix) {
  const std::string found = boot_parameter(root, "rcu_nocbs");
  std::set<int> spared = processors_in(found);
  spared.merge(processors_in(first_line(root / kCpus / "nohz_full").value_or("")));
  return make_check("rcu_callbacks", found == "all" || includes(spared, isolated),
                    isolated.empty() ? kNone
                    : found.empty()  ? "nowhere moved by rcu_nocbs"
                                     : "moved away from " + found,
                    "callbacks of the kernel elsewhere than on an isolated processor (rcu_nocbs)",
                    fix);
}

HostCheck default_interrupts(const fs::path& root, const std::set<int>& isolated,
                             const std::string& fix) {
  const std::string found = first_line(root / "proc/irq/default_smp_affinity").value_or("");
  const std::set<int> served = processors_in_mask(found);
  const bool apart = std::none_of(isolated.begin(), isolated.end(),
                                  [&](int cpu) { return served.count(cpu) > 0; });
  return make_check("interrupts", apart,
                    isolated.empty() ? kNone
                    : found.empty()  ? "unknown"
                                     : "mask " + found,
                    "interrupts elsewhere than on an isolated processor (irqaffinity)", fix);
}

/// Two processors of one core share its units and caches.
HostCheck hyper_threads(const fs::path& root, const std::set<int>& isolated) {
  std::string found;
  for (const int cpu : isolated) {
    const fs::path core = root / kCpus / ("cpu" + std::to_string(cpu)) / "topology";
    // Those that are switched off are not in it.
    const std::string siblings = first_line(core / "thread_siblings_list").value_or("");
    if (includes(isolated, processors_in(siblings))) continue;
    append(found, "; ", "processors " + siblings + " are one core");
  }
  const bool ok = found.empty();
  if (ok) found = isolated.empty() ? kNone : "no isolated processor shares its core";
  return make_check("hyper_threads", ok, found, "a core that only the loop uses",
                    "echo off | sudo tee /sys/devices/system/cpu/smt/control (until the next "
                    "start; for good in the firmware's set-up, or by the kernel parameter nosmt)");
}

}  // namespace

std::set<int> isolated_processors(const fs::path& root) {
  return processors_in(first_line(root / kCpus / "isolated").value_or(""));
}

std::vector<HostCheck> processor_checks(const fs::path& root) {
  const std::set<int> online = processors_in(first_line(root / kCpus / "online").value_or(""));
  const std::set<int> isolated = isolated_processors(root);
  const std::string fix = boot_advice(isolated.empty() ? online : isolated);
  return {isolated_cpus(root, online), tickless_cpus(root, isolated, fix),
          rcu_callbacks(root, isolated, fix), default_interrupts(root, isolated, fix),
          hyper_threads(root, isolated)};
}

}  // namespace palpate::realtime
