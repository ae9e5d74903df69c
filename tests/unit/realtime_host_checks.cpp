// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/host_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <set>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

/// A tree of /proc and /sys files of our own.
class HostChecks : public ::testing::Test {
 protected:
  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((root / file).parent_path());
    std::ofstream(root / file) << text << '\n';
  }

  HostCheck find(const std::string& name, const HostRights& rights = {}) const {
    const auto checks = check_host(rights, root);
    const auto it = std::find_if(checks.begin(), checks.end(),
                                 [&](const HostCheck& c) { return c.check == name; });
    return it == checks.end() ? HostCheck{} : *it;
  }

  palpate::test::TemporaryFolder folder;
  fs::path root = folder.path();
};

TEST_F(HostChecks, tuned_host_passes_every_check) {
  put("proc/version", "Linux version 6.1.0-rt (x) #1 SMP PREEMPT_RT Debian");
  put("proc/sys/kernel/sched_rt_runtime_us", "-1");
  put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
  put("sys/devices/system/cpu/online", "0-1");
  put("sys/devices/system/cpu/isolated", "1");
  put("sys/devices/system/cpu/nohz_full", "1");
  put("proc/irq/default_smp_affinity", "1");
  put("sys/devices/system/cpu/cpu1/topology/thread_siblings_list", "1");
  put("sys/bus/pci/devices/0000:00:14.0/class", "0x0c0330");
  put("sys/bus/pci/devices/0000:00:14.0/link/l1_aspm", "0");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  put("sys/module/usbcore/parameters/autosuspend", "-1");
  put("dev/cpu_dma_latency", "");
  put("etc/udev/rules.d/70-palpate.rules", "");
  HostRights rights;
  rights.max_fifo_priority = 95;
  rights.max_locked_bytes = std::numeric_limits<std::uint64_t>::max();
  for (const HostCheck& c : check_host(rights, root)) {
    EXPECT_TRUE(c.ok) << c.check << ": " << c.found;
    EXPECT_TRUE(c.fix.empty()) << c.check;
  }
}

TEST_F(HostChecks, ordinary_host_is_told_what_to_fix) {
  put("proc/version", "Linux version 6.1.0 (x) #1 SMP PREEMPT_DYNAMIC Debian");
  put("proc/sys/kernel/sched_rt_runtime_us", "500000");
  put("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  put("sys/devices/system/cpu/isolated", "");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  put("sys/module/usbcore/parameters/autosuspend", "2");
  HostRights rights;
  rights.max_locked_bytes = 8u << 20;
  std::set<std::string> failed;
  for (const HostCheck& c : check_host(rights, root)) {
    if (c.ok) continue;
    failed.insert(c.check);
    EXPECT_FALSE(c.fix.empty()) << c.check;
    EXPECT_FALSE(c.found.empty()) << c.check;
    EXPECT_FALSE(c.wanted.empty()) << c.check;
  }
  EXPECT_EQ(failed, (std::set<std::string>{"kernel_preemption", "rtprio_limit", "memlock_limit",
                                           "realtime_throttling", "clock_source", "isolated_cpus",
                                           "frequency_scaling", "usb_autosuspend", "udev_rule"}));
  // One command fixes what is not of the kernel.
  for (const char* check :
       {"rtprio_limit", "memlock_limit", "frequency_scaling", "usb_autosuspend", "udev_rule"}) {
    EXPECT_EQ(find(check).fix.rfind("sudo tools/setup/host", 0), 0u) << check;
  }
  EXPECT_EQ(find("kernel_preemption").found, "PREEMPT_DYNAMIC");
}

TEST_F(HostChecks, installed_copy_names_the_script_that_lies_with_it) {
  for (const HostCheck& c : check_host({}, root, "/opt/share/palpate/tools/setup/host")) {
    EXPECT_EQ(c.fix.find("sudo tools/"), std::string::npos) << c.check;
    if (c.check == "udev_rule") {
      EXPECT_EQ(c.fix, "sudo /opt/share/palpate/tools/setup/host");
    }
  }
}

TEST_F(HostChecks, capabilities_stand_in_for_limits) {
  HostRights rights;
  rights.any_priority = true;
  rights.any_memory = true;
  EXPECT_TRUE(find("rtprio_limit", rights).ok);
  EXPECT_TRUE(find("memlock_limit", rights).ok);
}

TEST_F(HostChecks, empty_tree_gives_every_check_an_answer) {
  const auto checks = check_host({}, root);
  EXPECT_EQ(checks.size(), 20u);
  for (const HostCheck& c : checks) EXPECT_FALSE(c.found.empty()) << c.check;
}

TEST(HostRights, this_process_has_some) {
  const HostRights rights = host_rights();
  EXPECT_TRUE(rights.any_memory || rights.max_locked_bytes > 0);
}

}  // namespace
}  // namespace palpate::realtime
