// SPDX-License-Identifier: GPL-3.0-or-later
// What `palpate doctor` finds out about processors and USB, in a tree of files of our own.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tools/realtime/host_checks.hpp"
#include "tools/realtime/host_files.hpp"

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

class HostTree : public ::testing::Test {
 protected:
  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((root / file).parent_path());
    std::ofstream(root / file) << text << '\n';
  }
  HostCheck find(const std::string& name) const {
    const auto checks = check_host({}, root);
    const auto it = std::find_if(checks.begin(), checks.end(),
                                 [&](const HostCheck& c) { return c.check == name; });
    EXPECT_NE(it, checks.end()) << name;
    return it == checks.end() ? HostCheck{} : *it;
  }
  /// A thread as /proc/PID/stat shows it. @param policy  1: SCHED_FIFO
  void put_thread(int pid, const std::string& name, int priority, int policy) const {
    std::string stat = std::to_string(pid) + " (" + name + ") S";
    for (int field = 4; field < 40; ++field) stat += " 0";
    put("proc/" + std::to_string(pid) + "/stat",
        stat + " " + std::to_string(priority) + " " + std::to_string(policy) + " 0 0");
  }
  void put_device(const std::string& name, const std::string& control,
                  const std::string& delay_s) const {
    const std::string device = "sys/bus/usb/devices/" + name + "/";
    put(device + "idVendor", "1209");
    put(device + name + ":1.0/bInterfaceClass", "ff");
    put(device + name + ":1.0/bInterfaceSubClass", "50");
    put(device + name + ":1.0/bInterfaceProtocol", "41");
    put(device + "power/control", control);
    put(device + "power/autosuspend", delay_s);
  }

  palpate::test::TemporaryFolder folder;
  fs::path root = folder.path();
};

using ProcessorChecks = HostTree;
using UsbChecks = HostTree;

TEST(Processors, are_read_from_lists_and_masks) {
  EXPECT_EQ(processors_in("0-2,5"), (std::set<int>{0, 1, 2, 5}));
  EXPECT_EQ(processors_in("(null)"), std::set<int>{});
  EXPECT_EQ(processors_in(""), std::set<int>{});
  EXPECT_EQ(processors_in_mask("d"), (std::set<int>{0, 2, 3}));
  EXPECT_EQ(processors_in_mask("00000001,00000002"), (std::set<int>{1, 32}));
}

TEST_F(ProcessorChecks, host_with_one_processor_is_not_told_to_isolate_it) {
  put("sys/devices/system/cpu/online", "0");
  put("sys/devices/system/cpu/isolated", "");
  for (const char* check :
       {"isolated_cpus", "tickless_cpus", "rcu_callbacks", "interrupts", "hyper_threads"}) {
    EXPECT_TRUE(find(check).ok) << check;
  }
}

TEST_F(ProcessorChecks, last_processor_is_advised_for_the_loop) {
  put("sys/devices/system/cpu/online", "0-3");
  put("sys/devices/system/cpu/isolated", "");
  EXPECT_EQ(find("isolated_cpus").fix,
            "boot with the kernel parameters: isolcpus=3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2, "
            "then palpate run --cpu 3");
}

TEST_F(ProcessorChecks, isolated_processor_with_ticks_callbacks_or_interrupts_is_named) {
  put("sys/devices/system/cpu/online", "0-3");
  put("sys/devices/system/cpu/isolated", "2");
  put("proc/irq/default_smp_affinity", "f");
  EXPECT_TRUE(find("isolated_cpus").ok);
  for (const char* check : {"tickless_cpus", "rcu_callbacks", "interrupts"}) {
    EXPECT_FALSE(find(check).ok) << check;
    EXPECT_NE(find(check).fix.find("=2 "), std::string::npos) << find(check).fix;
  }
  put("sys/devices/system/cpu/nohz_full", "2");
  put("proc/irq/default_smp_affinity", "b");
  for (const char* check : {"tickless_cpus", "rcu_callbacks", "interrupts"}) {
    EXPECT_TRUE(find(check).ok) << check;
  }
  put("sys/devices/system/cpu/nohz_full", "");
  put("proc/cmdline", "quiet rcu_nocbs=2-3 splash");
  EXPECT_TRUE(find("rcu_callbacks").ok);
}

TEST_F(ProcessorChecks, isolated_processor_that_shares_its_core_is_named) {
  put("sys/devices/system/cpu/online", "0-3");
  put("sys/devices/system/cpu/isolated", "3");
  put("sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "1,3");
  EXPECT_FALSE(find("hyper_threads").ok);
  EXPECT_EQ(find("hyper_threads").found, "processors 1,3 are one core");
  put("sys/devices/system/cpu/isolated", "1,3");
  EXPECT_TRUE(find("hyper_threads").ok);
  put("sys/devices/system/cpu/isolated", "3");
  put("sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "3");  // 1 is switched off
  EXPECT_TRUE(find("hyper_threads").ok);
}

TEST_F(UsbChecks, threads_that_serve_usb_must_be_above_the_loop) {
  put_thread(7, "irq/30-ahci[000", 50, 1);  // of a disk
  put_thread(8, "ktimers/0", 1, 1);         // does not serve USB here
  EXPECT_TRUE(find("usb_threads").ok) << find("usb_threads").found;
  put_thread(101, "irq/127-xhci_hc", 50, 1);
  put_thread(102, "vhci_rx", 0, 0);
  put_thread(103, "vhci_tx", 86, 1);
  const HostCheck check = find("usb_threads");
  EXPECT_FALSE(check.ok);
  EXPECT_NE(check.found.find("irq/127-xhci_hc at priority 50"), std::string::npos) << check.found;
  EXPECT_NE(check.found.find("vhci_rx at SCHED_OTHER"), std::string::npos) << check.found;
  EXPECT_NE(check.fix.find("sudo chrt -f -p 86 101"), std::string::npos) << check.fix;
  EXPECT_NE(check.fix.find("sudo chrt -f -p 86 102"), std::string::npos) << check.fix;
  EXPECT_EQ(check.fix.find(" 103"), std::string::npos) << check.fix;
  put_thread(101, "irq/127-xhci_hc", 86, 1);
  put_thread(102, "vhci_rx", 86, 1);
  EXPECT_TRUE(find("usb_threads").ok);
}

TEST_F(UsbChecks, threads_of_timers_serve_a_controller_that_is_emulated_by_them) {
  put("sys/module/dummy_hcd/refcnt", "1");
  put_thread(8, "ktimers/0", 1, 1);
  EXPECT_EQ(find("usb_threads").fix, "sudo chrt -f -p 86 8");
  put_thread(8, "ktimers/0", 86, 1);
  EXPECT_TRUE(find("usb_threads").ok);
}

TEST_F(UsbChecks, interrupt_on_the_loops_processor_is_named) {
  put("sys/devices/system/cpu/online", "0-1");
  put("sys/devices/system/cpu/isolated", "1");
  put("proc/interrupts",
      "           CPU0       CPU1\n"
      "  34:          0       1234  IR-PCI-MSI  xhci_hcd\n"
      "  35:          0       1234  IR-PCI-MSI  ahci[0000:00:17.0]");
  put("proc/irq/34/effective_affinity_list", "1");
  put("proc/irq/35/effective_affinity_list", "1");
  EXPECT_EQ(find("usb_interrupts").fix, "echo 0 | sudo tee /proc/irq/34/smp_affinity_list");
  put("proc/irq/34/effective_affinity_list", "0");
  EXPECT_TRUE(find("usb_interrupts").ok);
}

TEST_F(UsbChecks, usb_that_could_be_loaded_and_usb_that_is_not_there_are_told_apart) {
  EXPECT_TRUE(find("usb_core").ok);
  EXPECT_EQ(find("usb_core").found, "no USB in this kernel: the mock device only");
  put("proc/sys/kernel/osrelease", "6.1.0-rt");
  put("lib/modules/6.1.0-rt/modules.dep", "kernel/drivers/usb/core/usbcore.ko: kernel/x.ko");
  EXPECT_FALSE(find("usb_core").ok);
  EXPECT_NE(find("usb_core").fix.find("sudo modprobe"), std::string::npos);
  put("sys/module/usbcore/parameters/autosuspend", "-1");
  EXPECT_TRUE(find("usb_core").ok);
}

TEST_F(UsbChecks, autosuspend_is_off_where_each_haptic_device_is_kept_awake) {
  put("sys/module/usbcore/parameters/autosuspend", "2");
  EXPECT_FALSE(find("usb_autosuspend").ok);
  put_device("1-1", "on", "2");
  EXPECT_TRUE(find("usb_autosuspend").ok) << find("usb_autosuspend").found;
  put_device("1-2", "auto", "-1");
  EXPECT_EQ(find("usb_autosuspend").ok, true);
  put_device("2-1.4", "auto", "2");
  const HostCheck check = find("usb_autosuspend");
  EXPECT_FALSE(check.ok);
  EXPECT_EQ(check.found, "2-1.4 after 2 s (power/control is auto)");
}

TEST_F(UsbChecks, udev_rule_keeps_devices_awake_that_are_not_plugged_in_yet) {
  put("sys/module/usbcore/parameters/autosuspend", "2");
  put("etc/udev/rules.d/70-palpate.rules", "");
  EXPECT_TRUE(find("usb_autosuspend").ok);
}

TEST_F(UsbChecks, device_that_shares_a_hub_is_named) {
  put_device("1-1", "on", "2");
  put("sys/bus/usb/devices/1-2/bDeviceClass", "00");
  EXPECT_TRUE(find("usb_port").ok) << find("usb_port").found;
  put_device("2-1.4", "on", "2");
  put("sys/bus/usb/devices/2-1/bDeviceClass", "09");
  put("sys/bus/usb/devices/2-1.1/bDeviceClass", "09");
  put("sys/bus/usb/devices/2-1.4:1.0/bInterfaceClass", "ff");
  EXPECT_TRUE(find("usb_port").ok) << find("usb_port").found;
  put("sys/bus/usb/devices/2-1.1.3/bDeviceClass", "00");
  EXPECT_FALSE(find("usb_port").ok);
  EXPECT_EQ(find("usb_port").found, "2-1.4 shares the hub 2-1 with 2-1.1.3");
}

TEST_F(UsbChecks, link_to_the_controller_that_may_sleep_is_named) {
  const std::string controller = "sys/bus/pci/devices/0000:03:00.0/";
  put("sys/bus/pci/devices/0000:01:00.0/class", "0x010802");  // a disk
  put("sys/bus/pci/devices/0000:01:00.0/link/l1_aspm", "1");
  put(controller + "class", "0x0c0330");
  put(controller + "link/l0s_aspm", "0");
  EXPECT_TRUE(find("usb_bus_power").ok) << find("usb_bus_power").found;
  put(controller + "link/l1_aspm", "1");
  const HostCheck check = find("usb_bus_power");
  EXPECT_FALSE(check.ok);
  EXPECT_EQ(check.found, "links that may sleep: 0000:03:00.0 by l1_aspm");
  EXPECT_EQ(check.fix.rfind("echo 0 | sudo tee /" + controller + "link/l1_aspm (", 0), 0u)
      << check.fix;
}

}  // namespace
}  // namespace palpate::realtime
