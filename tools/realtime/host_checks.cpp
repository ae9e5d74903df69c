// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/host_checks.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <limits>

#include "tools/realtime/host_files.hpp"
#include "tools/realtime/processor_checks.hpp"
#include "tools/realtime/usb_checks.hpp"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kWantedPriority = kLoopPriority;

std::string number_or_unlimited(std::uint64_t value, const char* unit) {
  return value == kUnlimited ? "unlimited" : std::to_string(value) + unit;
}

HostCheck kernel_preemption(const fs::path& root) {
  const std::string version = first_line(root / "proc/version").value_or("unknown kernel");
  const bool realtime = first_line(root / "sys/kernel/realtime").value_or("0") == "1" ||
                        version.find("PREEMPT_RT") != std::string::npos;
  std::string found = "no preemption";
  for (const char* model : {"PREEMPT", "PREEMPT_DYNAMIC"}) {
    if (version.find(model) != std::string::npos) found = model;
  }
  return make_check("kernel_preemption", realtime, realtime ? "PREEMPT_RT" : found, "PREEMPT_RT",
                    "sudo apt install linux-image-rt-amd64 && sudo reboot");
}

HostCheck rtprio_limit(const HostRights& rights, const std::string& set_up) {
  const bool ok = rights.any_priority || rights.max_fifo_priority >= kWantedPriority;
  return make_check("rtprio_limit", ok,
                    rights.any_priority ? "any (CAP_SYS_NICE)"
                                        : number_or_unlimited(rights.max_fifo_priority, ""),
                    "at least " + std::to_string(kWantedPriority), set_up + ", then log in again");
}

HostCheck memlock_limit(const HostRights& rights, const std::string& set_up) {
  const bool ok = rights.any_memory || rights.max_locked_bytes == kUnlimited;
  return make_check("memlock_limit", ok,
                    rights.any_memory ? "any (CAP_IPC_LOCK)"
                                      : number_or_unlimited(rights.max_locked_bytes, " bytes"),
                    "unlimited", set_up + ", then log in again");
}

HostCheck realtime_throttling(const fs::path& root) {
  const std::string found =
      first_line(root / "proc/sys/kernel/sched_rt_runtime_us").value_or("unknown");
  return make_check("realtime_throttling", found == "-1" || found == "950000" || found == "1000000",
                    found + " µs of each second for real-time threads", "-1 (no bound) or 950000",
                    "sudo sysctl -w kernel.sched_rt_runtime_us=950000");
}

HostCheck clock_source(const fs::path& root) {
  const std::string found =
      first_line(root / "sys/devices/system/clocksource/clocksource0/current_clocksource")
          .value_or("unknown");
  const bool ok = found == "tsc" || found == "arch_sys_counter" || found == "kvm-clock";
  return make_check("clock_source", ok, found,
                    "tsc, arch_sys_counter or kvm-clock (read without a system call)",
                    "boot with the kernel parameters: clocksource=tsc tsc=reliable");
}

HostCheck cpu_dma_latency(const fs::path& root, const std::string& set_up) {
  const fs::path file = root / "dev/cpu_dma_latency";
  const bool exists = fs::exists(file);
  const bool ok = !exists || ::access(file.c_str(), W_OK) == 0;
  return make_check("cpu_dma_latency", ok,
                    !exists ? "no processor sleep states"
                    : ok    ? "writable"
                            : "not writable",
                    "/dev/cpu_dma_latency writable, so that the loop can keep processors awake",
                    set_up);
}

HostCheck frequency_scaling(const fs::path& root, const std::string& set_up) {
  std::error_code unreadable;
  std::string found;
  for (const auto& cpu : fs::directory_iterator(root / "sys/devices/system/cpu", unreadable)) {
    const auto governor = first_line(cpu.path() / "cpufreq/scaling_governor");
    if (!governor || *governor == "performance") continue;
    found = *governor;
  }
  return make_check("frequency_scaling", found.empty(),
                    found.empty() ? "none, or performance" : found,
                    "the governor performance on every processor", set_up);
}

bool flushes_denormals() {
#if defined(__SSE__)
  constexpr unsigned kFlushToZeroAndDenormalsAreZero = 0x8040;
  return (_mm_getcsr() & kFlushToZeroAndDenormalsAreZero) != 0;
#elif defined(__aarch64__)
  std::uint64_t fpcr = 0;
  __asm__("mrs %0, fpcr" : "=r"(fpcr));
  constexpr std::uint64_t kFlushToZero = std::uint64_t(1) << 24;
  return (fpcr & kFlushToZero) != 0;
#else
  return false;
#endif
}

HostCheck denormal_mode() {
  const bool flushed = flushes_denormals();
  return make_check("denormal_mode", !flushed, flushed ? "flushed to zero" : "kept",
                    "kept: the loop, a replay and a device must give the same bits",
                    "do not preload libraries that were built with -ffast-math");
}

/// Effective capabilities of this process, as a set of bits; none where unknown.
std::uint64_t effective_capabilities() {
  std::ifstream status("/proc/self/status");
  const std::string key = "CapEff:";
  for (std::string line; std::getline(status, line);) {
    if (line.compare(0, key.size(), key) == 0)
      return std::stoull(line.substr(key.size()), nullptr, 16);
  }
  return 0;
}

std::uint64_t soft_limit(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? kUnlimited : limit.rlim_cur;
}

}  // namespace

HostRights host_rights() {
  // Bits of linux/capability.h.
  constexpr std::uint64_t kIpcLock = std::uint64_t(1) << 14;
  constexpr std::uint64_t kSysNice = std::uint64_t(1) << 23;
  const std::uint64_t capabilities = effective_capabilities();
  HostRights rights;
  rights.max_fifo_priority = soft_limit(RLIMIT_RTPRIO);
  rights.max_locked_bytes = soft_limit(RLIMIT_MEMLOCK);
  rights.any_priority = (capabilities & kSysNice) != 0;
  rights.any_memory = (capabilities & kIpcLock) != 0;
  return rights;
}

fs::path set_up_script() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  const fs::path installed =
      (program.parent_path() / "../share/palpate/tools/setup/host").lexically_normal();
  return fs::exists(installed, none) ? installed : fs::path("tools/setup/host");
}

std::vector<HostCheck> check_host(const HostRights& rights, const fs::path& root,
                                  const fs::path& script) {
  const std::string set_up = "sudo " + script.string();
  std::vector<HostCheck> checks = {kernel_preemption(root),
                                   rtprio_limit(rights, set_up),
                                   memlock_limit(rights, set_up),
                                   realtime_throttling(root),
                                   clock_source(root),
                                   cpu_dma_latency(root, set_up),
                                   frequency_scaling(root, set_up),
                                   denormal_mode()};
  for (const auto& more : {processor_checks(root), usb_checks(root, set_up)}) {
    checks.insert(checks.end(), more.begin(), more.end());
  }
  return checks;
}

}  // namespace palpate::realtime
