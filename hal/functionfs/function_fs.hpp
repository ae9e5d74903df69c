// SPDX-License-Identifier: Apache-2.0
// A device on the USB of a Linux board that has a device controller, behind the kernel's FunctionFS
// (Documentation/usb/functionfs.rst of Linux): the kernel enumerates and moves the packets, the
// device's half of the protocol answers. An example for devices that run Linux; what it takes to
// make the gadget and to bind it is in tools/gadget.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/simulator/simulated_device.hpp"

namespace palpate::hal::functionfs {

/// What FunctionFS is told of a device: the interfaces and endpoints of its configuration, for full
/// and for high speed. @param d  of high speed, with interrupt endpoints
[[nodiscard]] std::vector<std::byte> descriptors_of(const simulator::UsbDescriptors& d);

/// An open file that closes itself.
class File {
 public:
  /// Throws std::system_error.
  explicit File(const std::filesystem::path& path);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  File(File&&) = delete;
  File& operator=(File&&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_; }

 private:
  int fd_;
};

/// A device of one interface with an IN and an OUT endpoint, in this order. Requests go to the
/// interface and carry no data to the device: the open protocol without updates.
class FunctionFs {
 public:
  /// Tells the kernel what the device is; the gadget can be bound from then on. Device and clock
  /// must outlive this. @param folder  where FunctionFS is mounted. Throws std::system_error.
  FunctionFs(simulator::SimulatedDevice& device, Clock& clock, const std::filesystem::path& folder);

  /// The device lives until `stop`, which is looked at ten times a second. Each of the directions
  /// and the device's periods have a thread of their own, with the caller's priority.
  /// @param watch  called after each of the device's periods, never twice at a time
  void run(const std::atomic<bool>& stop, const std::function<void()>& watch);

  /// A host has configured the device.
  [[nodiscard]] bool attached() const noexcept { return attached_; }

 private:
  /// A thread that may be waiting in the kernel.
  struct Worker {
    std::thread thread;
    std::atomic<bool> done{false};
  };
  template <class Work>
  void start(Worker& worker, Work work);
  static void finish(Worker& worker);
  void live(const std::function<void()>& watch);
  void send();
  void receive();
  void handle_events();
  void answer(const ControlRequest& request, std::size_t length);

  simulator::SimulatedDevice& device_;
  Clock& clock_;
  File control_;
  std::optional<File> in_, out_;
  std::mutex mutex_;  ///< of the device
  std::condition_variable period_;
  std::atomic<bool> attached_{false};
  std::atomic<bool> stop_{false};
};

}  // namespace palpate::hal::functionfs
