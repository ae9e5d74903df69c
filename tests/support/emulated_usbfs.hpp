// SPDX-License-Identifier: Apache-2.0
// Linux usbfs for one simulated device, inside the process of its user: the real libusb talks to it
// through a file descriptor whose system calls are answered here (usbfs_calls.cpp where it is
// linked in, usbfs_shim.cpp where it is preloaded). It refuses what the kernel refuses: an
// interface that another file has claimed, endpoints and interfaces that are not there, requests
// longer than their buffer. What it leaves out: bandwidth.
#pragma once

#include <libusb-1.0/libusb.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/simulator/simulated_device.hpp"
#include "usbfs_file.hpp"

namespace palpate::hal::test {

/// The device lives on a thread of its own, on the real clock.
class EmulatedUsbfs {
 public:
  explicit EmulatedUsbfs(simulator::SimulatedDevice& device);
  ~EmulatedUsbfs();
  EmulatedUsbfs(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs& operator=(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs(EmulatedUsbfs&&) = delete;
  EmulatedUsbfs& operator=(EmulatedUsbfs&&) = delete;

  /// A file of its own for each call, for libusb_wrap_sys_device(); a negative errno while the
  /// device is not on the bus. What is not closed ends with this.
  [[nodiscard]] int open();
  /// Gives up the file's claims and transfers.
  void close(int fd);

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
  int on_ioctl(int fd, unsigned long request, void* argument);
  long on_read(int fd, void* out, std::size_t bytes);
  long on_seek(int fd, long offset);

 private:
  struct Failure {
    std::uint8_t endpoint;
    int error;
    int times;
  };
  struct Transfer {
    usbdevfs_urb* urb;
    UsbfsFile* file;
  };
  void live();
  void serve();
  void pull_plug();
  [[nodiscard]] UsbfsFile* file_of(int fd);
  int request_of(UsbfsFile& file, unsigned long request, void* argument);
  int claim(UsbfsFile& file, unsigned interface);
  int claim_for_endpoint(UsbfsFile& file, std::uint8_t address);
  int claim_for_control(UsbfsFile& file, const std::byte* setup);
  int set_alternate(UsbfsFile& file, unsigned interface, int setting);
  int submit(UsbfsFile& file, usbdevfs_urb* urb);
  int discard(UsbfsFile& file, usbdevfs_urb* urb);
  static int reap(UsbfsFile& file, usbdevfs_urb** out);
  void control(const Transfer& transfer);
  void cancel_all(const UsbfsFile& file, int status);
  static void complete(const Transfer& transfer, int status, int length);
  [[nodiscard]] int failure_of(std::uint8_t endpoint);

  simulator::SimulatedDevice& device_;
  std::vector<std::uint8_t> descriptors_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<UsbfsFile>> files_;
  std::deque<Transfer> in_, out_, held_;
  std::vector<Failure> failures_;
  bool hold_out_ = false;
  bool hold_control_ = false;
  bool unplugged_ = false;
  std::uint32_t times_left_ = 0;  ///< what the device says
  int submissions_left_ = -1;     ///< until the plug is pulled; below 0: never
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
