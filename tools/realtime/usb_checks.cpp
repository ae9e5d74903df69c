// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/usb_checks.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>

#include "tools/realtime/host_files.hpp"
#include "tools/realtime/processor_checks.hpp"
#include "tools/realtime/usb_device_checks.hpp"

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

constexpr std::array kHostControllers = {"xhci", "ehci", "ohci", "uhci", "dwc2", "dwc3", "musb"};

bool names_a_host_controller(const std::string& text) {
  return std::any_of(kHostControllers.begin(), kHostControllers.end(),
                     [&](const char* name) { return text.find(name) != std::string::npos; });
}

bool usb_is_loaded(const fs::path& root) {
  return fs::exists(root / "sys/module/usbcore") || fs::exists(root / "sys/bus/usb");
}

HostCheck usb_core(const fs::path& root) {
  const std::string release = first_line(root / "proc/sys/kernel/osrelease").value_or("");
  std::ifstream modules(root / "lib/modules" / release / "modules.dep");
  bool could_be = false;
  for (std::string line; std::getline(modules, line);) {
    could_be = could_be || line.find("/usbcore.ko") != std::string::npos;
  }
  const bool loaded = usb_is_loaded(root);
  return make_check("usb_core", loaded || !could_be,
                    loaded     ? "loaded"
                    : could_be ? "usbcore is not loaded: no device can be found"
                               : "no USB in this kernel: the mock device only",
                    "USB in the kernel, for devices",
                    "sudo modprobe xhci-pci (or the driver of this host's USB controller)");
}

struct Thread {
  std::string pid;
  std::string name;
  int policy = 0;  ///< SCHED_FIFO is 1
  int priority = 0;
  [[nodiscard]] bool above_the_loop() const {
    return (policy == 1 || policy == 2) && priority > kLoopPriority;
  }
};

/// Of /proc/PID/stat: the name stands in brackets, priority and policy are fields 40 and 41.
Thread thread_of(const fs::path& process) {
  Thread thread;
  thread.pid = process.filename().string();
  const std::string stat = first_line(process / "stat").value_or("");
  const std::size_t open = stat.find('('), close = stat.rfind(')');
  if (open == std::string::npos || close == std::string::npos || close < open) return thread;
  thread.name = stat.substr(open + 1, close - open - 1);
  std::istringstream rest(stat.substr(close + 1));
  constexpr int kFirst = 3, kPriority = 40;
  std::string skipped;
  for (int field = kFirst; field < kPriority; ++field) rest >> skipped;
  rest >> thread.priority >> thread.policy;
  return thread;
}

/// Threads of interrupts where the kernel has them, of USB/IP's client, and where a controller is
/// emulated by timers (dummy_hcd) those of timers.
bool serves_usb(const std::string& name, bool by_timers) {
  if (name.rfind("irq/", 0) == 0) return names_a_host_controller(name);
  if (name.rfind("vhci_", 0) == 0) return true;
  return by_timers && name.rfind("ktimers/", 0) == 0;
}

HostCheck usb_threads(const fs::path& root) {
  const bool by_timers = fs::exists(root / "sys/module/dummy_hcd");
  std::string found, fix;
  bool ok = true;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(root / "proc", unreadable)) {
    const std::string pid = entry.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    const Thread thread = thread_of(entry.path());
    if (!serves_usb(thread.name, by_timers)) continue;
    append(
        found, ", ",
        thread.name + " at " +
            (thread.policy == 0 ? "SCHED_OTHER" : "priority " + std::to_string(thread.priority)));
    if (thread.above_the_loop()) continue;
    ok = false;
    append(fix, " && ", "sudo chrt -f -p 86 " + pid);
  }
  return make_check("usb_threads", ok,
                    found.empty() ? "none: this kernel serves USB in interrupts" : found,
                    "threads that serve USB at SCHED_FIFO above the loop, which takes " +
                        std::to_string(kLoopPriority),
                    fix);
}

HostCheck usb_interrupts(const fs::path& root) {
  const std::set<int> isolated = isolated_processors(root);
  std::string found, fix;
  bool ok = true;
  std::ifstream interrupts(root / "proc/interrupts");
  for (std::string line; std::getline(interrupts, line);) {
    if (!names_a_host_controller(line)) continue;
    std::string number;
    std::istringstream(line) >> number;
    if (!number.empty() && number.back() == ':') number.pop_back();
    const fs::path irq = root / "proc/irq" / number;
    const std::string where =
        first_line(irq / "effective_affinity_list")
            .value_or(first_line(irq / "smp_affinity_list").value_or("unknown"));
    append(found, ", ", number);
    append(found, " on ", where);
    const std::set<int> served = processors_in(where);
    const bool apart = std::none_of(served.begin(), served.end(),
                                    [&](int cpu) { return isolated.count(cpu) > 0; });
    if (apart) continue;
    ok = false;
    append(fix, " && ", "echo 0 | sudo tee /proc/irq/" + number + "/smp_affinity_list");
  }
  return make_check("usb_interrupts", ok,
                    found.empty() ? "none" : "interrupts and processors: " + found,
                    "of the USB controller, elsewhere than on the loop's processor", fix);
}

HostCheck udev_rule(const fs::path& root, const std::string& set_up) {
  const bool ok = udev_rule_installed(root);
  return make_check("udev_rule", ok, ok ? "installed" : "not installed",
                    "70-palpate.rules, so that haptic devices may be used without root", set_up);
}

}  // namespace

std::vector<HostCheck> usb_checks(const fs::path& root, const std::string& set_up) {
  std::vector<HostCheck> checks = {usb_core(root), usb_threads(root), usb_interrupts(root),
                                   udev_rule(root, set_up)};
  const auto more = usb_device_checks(root, set_up);
  checks.insert(checks.end(), more.begin(), more.end());
  return checks;
}

}  // namespace palpate::realtime
