// SPDX-License-Identifier: Apache-2.0
// Linux usbfs for one simulated device, inside the process of its user: the real libusb talks to it
// through a file descriptor whose system calls are answered here (usbfs_calls.cpp where it is
// linked in, usbfs_shim.cpp where it is preloaded). What it leaves out: bandwidth, and the kernel's
// checks of requests.
//
// libusb is given the writing end of a pipe of one page. While the pipe is full there is nothing to
// reap; drained, it is ready for writing, which is how usbfs says that a transfer has completed;
// with the reading end closed it reports an error, which is how usbfs says that the device is gone.
#pragma once

#include <libusb-1.0/libusb.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/simulator/simulated_device.hpp"

struct usbdevfs_urb;

namespace palpate::hal::test {

/// At most kMost at a time. The device lives on a thread of its own, on the real clock.
class EmulatedUsbfs {
 public:
  static constexpr std::size_t kMost = 4;

  explicit EmulatedUsbfs(simulator::SimulatedDevice& device);
  ~EmulatedUsbfs();
  EmulatedUsbfs(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs& operator=(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs(EmulatedUsbfs&&) = delete;
  EmulatedUsbfs& operator=(EmulatedUsbfs&&) = delete;

  /// For libusb_wrap_sys_device().
  [[nodiscard]] int descriptor() const noexcept { return pipe_[1]; }

  void unplug();
  /// The plug is pulled when one transfer more than these is submitted.
  void unplug_after(int submissions);
  /// Interfaces cannot be claimed: a negative errno.
  void refuse_claims(int error);
  /// OUT transfers stay under way.
  void hold_out(bool hold);
  /// The next transfers of the endpoint end with a negative errno.
  void fail_next(std::uint8_t endpoint, int error, int times = 1);
  /// Control transfers get no answer.
  void hold_control(bool hold);
  /// Looks at the device between two of its moments.
  template <class Function>
  auto look(Function function) {
    const std::lock_guard lock(mutex_);
    return function();
  }

  /// Transfers submitted and not completed.
  [[nodiscard]] std::size_t under_way();
  [[nodiscard]] int halts_cleared();

  // The system calls.
  int on_ioctl(unsigned long request, void* argument);
  long on_read(void* out, std::size_t bytes);
  long on_seek(long offset);

 private:
  struct Failure {
    std::uint8_t endpoint;
    int error;
    int times;
  };
  void live();
  void serve();
  void pull_plug();
  int submit(usbdevfs_urb* urb);
  int discard(usbdevfs_urb* urb);
  int reap(usbdevfs_urb** out);
  void control(usbdevfs_urb* urb);
  void complete(usbdevfs_urb* urb, int status, int length);
  void signal(bool something_to_reap);
  [[nodiscard]] int failure_of(std::uint8_t endpoint);

  simulator::SimulatedDevice& device_;
  std::vector<std::uint8_t> descriptors_;
  std::size_t read_at_ = 0;
  int pipe_[2] = {-1, -1};
  bool signalled_ = true;  ///< the pipe is drained
  std::mutex mutex_;
  std::deque<usbdevfs_urb*> in_, out_, held_, done_;
  std::vector<Failure> failures_;
  bool hold_out_ = false;
  bool hold_control_ = false;
  bool unplugged_ = false;
  int submissions_left_ = -1;  ///< until the plug is pulled; below 0: never
  int claim_result_ = 0;
  int halts_cleared_ = 0;
  MonotonicClock clock_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// The emulation behind a file descriptor; null where it is another file's.
[[nodiscard]] EmulatedUsbfs* usbfs_of(int fd);

/// A negative errno as a system call returns it.
[[nodiscard]] long with_errno(long result);

}  // namespace palpate::hal::test
