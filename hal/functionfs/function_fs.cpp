// SPDX-License-Identifier: Apache-2.0
#include "hal/functionfs/function_fs.hpp"

#include <endian.h>
#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <span>
#include <system_error>

namespace palpate::hal::functionfs {
namespace {

constexpr std::size_t kPacketBytes = 64;
constexpr std::size_t kMaxControlBytes = 512;
constexpr std::size_t kConfigurationBytes = 9;  ///< of a configuration before its interfaces
constexpr std::uint8_t kEndpoint = 5;           ///< type of descriptor
constexpr std::size_t kInterval = 6;            ///< where an endpoint has it
constexpr int kLookEvery_ms = 100;
constexpr std::uint64_t kNoHost_ns = 1'000'000;

using Bytes = std::vector<std::byte>;

void append_u32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::byte>(value >> shift & 0xff));
  }
}

/// Calls back with each descriptor after the configuration's own.
template <class Callback>
void for_each_descriptor(std::span<const std::uint8_t> configuration, Callback callback) {
  for (auto rest = configuration.subspan(kConfigurationBytes); rest.size() >= 2 && rest[0] >= 2;
       rest = rest.subspan(std::min<std::size_t>(rest[0], rest.size()))) {
    callback(rest.first(std::min<std::size_t>(rest[0], rest.size())));
  }
}

void append_for_speed(Bytes& bytes, const simulator::UsbDescriptors& d, simulator::UsbSpeed speed) {
  for_each_descriptor(d.configuration, [&](std::span<const std::uint8_t> one) {
    std::transform(one.begin(), one.end(), std::back_inserter(bytes),
                   [](std::uint8_t b) { return std::byte{b}; });
    // At full speed it counts frames of 1 ms, at high speed powers of two of 125 us.
    if (one[1] == kEndpoint && speed == simulator::UsbSpeed::full) {
      bytes[bytes.size() - one.size() + kInterval] = std::byte{1};
    }
  });
}

/// Head of a block, whose second field is its length.
void set_length(Bytes& bytes) {
  Bytes length;
  append_u32(length, static_cast<std::uint32_t>(bytes.size()));
  std::copy(length.begin(), length.end(), bytes.begin() + 4);
}

/// None: the gadget's own say what the device is.
Bytes no_strings() {
  Bytes bytes;
  append_u32(bytes, FUNCTIONFS_STRINGS_MAGIC);
  for (int i = 0; i < 3; ++i) append_u32(bytes, 0);
  set_length(bytes);
  return bytes;
}

void tell(int fd, const Bytes& bytes, const std::filesystem::path& folder) {
  if (::write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size())) return;
  throw std::system_error(errno, std::generic_category(), folder.string() + ": descriptors");
}

}  // namespace

Bytes descriptors_of(const simulator::UsbDescriptors& d) {
  std::uint32_t count = 0;
  for_each_descriptor(d.configuration, [&](std::span<const std::uint8_t>) { ++count; });
  Bytes bytes;
  append_u32(bytes, FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
  append_u32(bytes, 0);
  append_u32(bytes, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC);
  append_u32(bytes, count);
  append_u32(bytes, count);
  append_for_speed(bytes, d, simulator::UsbSpeed::full);
  append_for_speed(bytes, d, simulator::UsbSpeed::high);
  set_length(bytes);
  return bytes;
}

File::File(const std::filesystem::path& path) : fd_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), path.string());
}

File::~File() {
  if (fd_ >= 0) ::close(fd_);
}

FunctionFs::FunctionFs(simulator::SimulatedDevice& device, Clock& clock,
                       const std::filesystem::path& folder)
    : device_(device), clock_(clock), control_(folder / "ep0") {
  tell(control_.fd(), descriptors_of(device.descriptors()), folder);
  tell(control_.fd(), no_strings(), folder);
  // The endpoints' files are there now, in the order of the descriptors.
  in_.emplace(folder / "ep1");
  out_.emplace(folder / "ep2");
}

template <class Work>
void FunctionFs::start(Worker& worker, Work work) {
  worker.thread = std::thread([&worker, work] {
    work();
    worker.done = true;
  });
}

/// A signal ends what it waits for in the kernel. One may come just before it waits: more follow.
void FunctionFs::finish(Worker& worker) {
  while (!worker.done) {
    // The handler only sets a flag (tools/palpate-sim): nothing is terminated.
    ::pthread_kill(worker.thread.native_handle(), SIGTERM);  // NOLINT(bugprone-bad-signal-*)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  worker.thread.join();
}

void FunctionFs::run(const std::atomic<bool>& stop, const std::function<void()>& watch) {
  Worker life, sender, receiver;
  start(life, [&] { live(watch); });
  start(sender, [&] { send(); });
  start(receiver, [&] { receive(); });
  while (!stop) {
    pollfd events{control_.fd(), POLLIN, 0};
    if (::poll(&events, 1, kLookEvery_ms) > 0) handle_events();
  }
  stop_ = true;
  for (Worker* worker : {&life, &sender, &receiver}) {
    period_.notify_all();
    finish(*worker);
  }
}

/// The device's watchdog is here: it needs no host.
void FunctionFs::live(const std::function<void()>& watch) {
  while (!stop_) {
    std::uint64_t next_ns;
    {
      const std::lock_guard lock(mutex_);
      device_.advance_to(clock_.now_ns());
      next_ns = device_.next_event_ns();
      watch();
    }
    period_.notify_all();
    clock_.sleep_until(next_ns);
  }
}

/// A write returns when the host has fetched the reading; the next one is then the newest.
void FunctionFs::send() {
  std::array<std::byte, kPacketBytes> packet;
  while (!stop_) {
    std::size_t length = 0;
    {
      std::unique_lock lock(mutex_);
      period_.wait(lock, [&] { return stop_ || (attached_ && (length = device_.in(packet)) > 0); });
    }
    if (stop_) return;
    // Where it fails the host has gone; what follows is for the next one.
    if (::write(in_->fd(), packet.data(), length) < 0)
      clock_.sleep_until(clock_.now_ns() + kNoHost_ns);
  }
}

void FunctionFs::receive() {
  std::array<std::byte, kPacketBytes> packet;
  while (!stop_) {
    const ssize_t length = ::read(out_->fd(), packet.data(), packet.size());
    if (length < 0) {
      clock_.sleep_until(clock_.now_ns() + kNoHost_ns);
      continue;
    }
    const std::lock_guard lock(mutex_);
    device_.advance_to(clock_.now_ns());
    device_.out(std::span(packet).first(static_cast<std::size_t>(length)));
  }
}

void FunctionFs::handle_events() {
  usb_functionfs_event event;
  if (::read(control_.fd(), &event, sizeof event) != static_cast<ssize_t>(sizeof event)) return;
  switch (event.type) {
    case FUNCTIONFS_ENABLE:
      attached_ = true;
      break;
    case FUNCTIONFS_DISABLE:
    case FUNCTIONFS_UNBIND:
    case FUNCTIONFS_SUSPEND: {
      const std::lock_guard lock(mutex_);
      attached_ = event.type == FUNCTIONFS_SUSPEND && attached_;
      device_.bus_reset();
      break;
    }
    case FUNCTIONFS_SETUP: {
      const usb_ctrlrequest& r = event.u.setup;
      answer({r.bRequestType, r.bRequest, le16toh(r.wValue), le16toh(r.wIndex)},
             le16toh(r.wLength));
      break;
    }
    default:
      break;
  }
}

/// Where the device refuses, moving data the other way makes the kernel stall.
void FunctionFs::answer(const ControlRequest& request, std::size_t length) {
  const bool to_host = (request.type & USB_DIR_IN) != 0;
  std::array<std::byte, kMaxControlBytes> data{};
  IoResult result;
  {
    const std::lock_guard lock(mutex_);
    device_.advance_to(clock_.now_ns());
    if (to_host) {
      result = device_.control_in(request, std::span(data).first(std::min(length, data.size())));
    } else {
      result = length == 0 ? device_.control_out(request, {}) : IoResult{IoStatus::stalled};
    }
  }
  // A host that has gone meanwhile gets no answer.
  if (to_host == result.ok()) {
    [[maybe_unused]] const ssize_t sent = ::write(control_.fd(), data.data(), result.bytes);
  } else {
    [[maybe_unused]] const ssize_t read = ::read(control_.fd(), data.data(), 0);
  }
}

}  // namespace palpate::hal::functionfs
