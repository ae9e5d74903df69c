// SPDX-License-Identifier: GPL-3.0-or-later
// A thread made ready for the loop as far as the host permits, and an account of what it did not
// permit.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/realtime/host_memory.hpp"

namespace palpate::realtime {

/// Not 99: the kernel's own threads for timers and migration run there.
inline constexpr int kMaxFifoPriority = 98;

struct RealtimeOptions {
  int fifo_priority = 80;  ///< 1 to kMaxFifoPriority; 0: stay an ordinary thread
  int cpu = -1;            ///< the processor to stay on; -1: any
};

/// What the host granted.
struct HostGrant {
  std::string scheduler = "SCHED_OTHER";  ///< of the thread, with its priority: "SCHED_FIFO 80"
  bool memory_locked = false;  ///< every page of the process is locked; else they were only touched
  std::vector<std::string> notes;  ///< what was not granted, why, and the fix; one line each
};

/// Runs a body once, on a thread of its own whose stack is touched, with all memory that the
/// process has by then locked (or, where that is not permitted, mapped), processor sleep states
/// bounded (/dev/cpu_dma_latency), pinned and scheduled as asked.
///
/// Floating point stays as the C++ runtime sets it: denormals are kept (no FTZ, no DAZ), because
/// the same poses must give the same bits in the loop, in a replay and on a device.
///
/// Memory that is mapped after the start is not locked: have all of it before. It stays locked
/// until this ends, for unlocking takes long and holds up whoever maps memory meanwhile: end it
/// once the device has been stopped. The thread itself leaves its priority as soon as its body has
/// returned.
class RealtimeThread {
 public:
  /// The body must not throw. Throws std::system_error where no thread can be made.
  RealtimeThread(const RealtimeOptions& options, std::function<void()> body);
  ~RealtimeThread();
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;
  RealtimeThread(RealtimeThread&&) = delete;
  RealtimeThread& operator=(RealtimeThread&&) = delete;

  /// Whether the body has returned.
  [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }

  /// Waits for the body to return. Once.
  HostGrant join();

 private:
  static void* entry(void* self);
  void prepare_and_run();

  RealtimeOptions options_;
  std::function<void()> body_;
  HostGrant grant_;
  std::optional<HostMemory> memory_;  ///< of the thread until it has ended
  std::atomic<bool> finished_{false};
  bool joined_ = false;
  pthread_t thread_{};
};

}  // namespace palpate::realtime
