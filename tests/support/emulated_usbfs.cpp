// SPDX-License-Identifier: Apache-2.0
#include "emulated_usbfs.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstring>

#include "hal/flash/dfu.hpp"
#include "hal/flash/dfu_device.hpp"
#include "hal/protocol/packets.hpp"

namespace palpate::hal::test {
namespace {

std::atomic<EmulatedUsbfs*> g_usbfs{nullptr};

constexpr std::uint64_t kLookEvery_ns = 100'000;
constexpr std::size_t kSetupBytes = 8;
constexpr int kHardwarePriority = 90;
constexpr int kHighSpeed = 3;
constexpr std::size_t kDeviceDescriptorBytes = 18;

std::vector<std::uint8_t> with_device(std::uint16_t vendor, std::uint16_t product,
                                      std::vector<std::uint8_t> configuration) {
  const auto low = [](std::uint16_t v) { return static_cast<std::uint8_t>(v & 0xff); };
  const auto high = [](std::uint16_t v) { return static_cast<std::uint8_t>(v >> 8); };
  const auto total = static_cast<std::uint16_t>(configuration.size());
  configuration[2] = low(total);
  configuration[3] = high(total);
  const std::array<std::uint8_t, kDeviceDescriptorBytes> device{
      kDeviceDescriptorBytes, 1, 0x00, 0x02, 0, 0, 0, 64, low(vendor), high(vendor), low(product),
      high(product),          0, 1,    0,    0, 0, 1};
  std::vector<std::uint8_t> all;
  for (const std::uint8_t b : device) all.push_back(b);
  for (const std::uint8_t b : configuration) all.push_back(b);
  return all;
}

}  // namespace

std::vector<std::uint8_t> open_device_descriptors() {
  using namespace flash;
  constexpr std::uint16_t kTransfer = DfuDevice::kTransferBytes;
  return with_device(0x1209, 0x0001,
                     // clang-format off
      {9, 2, 0, 0, 2, 1, 0, 0x80, 50,
       9, 4, 0, 0, 2, protocol::kInterfaceClass, protocol::kInterfaceSubclass, protocol::kInterfaceProtocol, 0,
       7, 5, 0x81, 3, 64, 0, 2,
       7, 5, 0x01, 3, 64, 0, 2,
       9, 4, 1, 0, 0, kDfuClass, kDfuSubclass, kDfuModeProtocol, 0,
       9, 4, 1, 1, 0, kDfuClass, kDfuSubclass, kDfuModeProtocol, 0,
       9, kFunctionalDescriptorType, kCanDownload | kCanUpload | kManifestationTolerant, 0, 0,
       kTransfer & 0xff, kTransfer >> 8, 0x10, 1});
  // clang-format on
}

std::vector<std::uint8_t> falcon_descriptors() {
  return with_device(0x0403, 0xcb48,
                     // clang-format off
                     {9, 2, 0, 0, 1, 1, 0, 0x80, 50,
                      9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 0,
                      7, 5, 0x81, 2, 64, 0, 0,
                      7, 5, 0x02, 2, 64, 0, 0});
  // clang-format on
}

EmulatedUsbfs::EmulatedUsbfs(simulator::SimulatedDevice& device,
                             std::vector<std::uint8_t> descriptors)
    : device_(device), descriptors_(std::move(descriptors)) {
  if (::pipe(pipe_) != 0) std::abort();
  const int page = static_cast<int>(::sysconf(_SC_PAGESIZE));
  ::fcntl(pipe_[1], F_SETPIPE_SZ, page);
  ::fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
  signal(false);
  g_usbfs = this;
  thread_ = std::thread([this] { live(); });
}

EmulatedUsbfs::~EmulatedUsbfs() {
  stopping_ = true;
  thread_.join();
  g_usbfs = nullptr;
  ::close(pipe_[1]);
  if (pipe_[0] >= 0) ::close(pipe_[0]);
}

void EmulatedUsbfs::live() {
  // Hardware does not wait for a processor; refused without the right to it.
  sched_param parameter{};
  parameter.sched_priority = kHardwarePriority;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  while (!stopping_) {
    std::uint64_t next_ns = 0;
    {
      const std::lock_guard lock(mutex_);
      device_.advance_to(clock_.now_ns());
      serve();
      next_ns = std::min(device_.next_event_ns(), clock_.now_ns() + kLookEvery_ns);
    }
    clock_.sleep_until(next_ns);
  }
}

/// Moves what can be moved between transfers and device.
void EmulatedUsbfs::serve() {
  if (unplugged_) return;
  while (!out_.empty() && !hold_out_) {
    usbdevfs_urb* urb = out_.front();
    out_.pop_front();
    const int error = failure_of(urb->endpoint);
    if (error == 0) {
      device_.out({static_cast<const std::byte*>(urb->buffer),
                   static_cast<std::size_t>(urb->buffer_length)});
    }
    complete(urb, error, error == 0 ? urb->buffer_length : 0);
  }
  while (!in_.empty()) {
    usbdevfs_urb* urb = in_.front();
    const int error = failure_of(urb->endpoint);
    std::array<std::byte, 512> bytes;
    const std::size_t length = error == 0 ? device_.in(bytes) : 0;
    if (length == 0 && error == 0) break;
    in_.pop_front();
    const auto room = static_cast<std::size_t>(urb->buffer_length);
    std::memcpy(urb->buffer, bytes.data(), std::min(length, room));
    const int status = length > room ? -EOVERFLOW : error;
    complete(urb, status, static_cast<int>(std::min(length, room)));
  }
}

void EmulatedUsbfs::unplug() {
  const std::lock_guard lock(mutex_);
  unplugged_ = true;
  device_.bus_reset();
  for (auto* queue : {&in_, &out_, &held_}) {
    for (usbdevfs_urb* urb : *queue) complete(urb, -ESHUTDOWN, 0);
    queue->clear();
  }
  ::close(pipe_[0]);
  pipe_[0] = -1;
}

void EmulatedUsbfs::hold_out(bool hold) {
  const std::lock_guard lock(mutex_);
  hold_out_ = hold;
}

void EmulatedUsbfs::hold_control(bool hold) {
  const std::lock_guard lock(mutex_);
  hold_control_ = hold;
}

void EmulatedUsbfs::fail_next(std::uint8_t endpoint, int error, int times) {
  const std::lock_guard lock(mutex_);
  failures_.push_back({endpoint, error, times});
}

int EmulatedUsbfs::failure_of(std::uint8_t endpoint) {
  for (Failure& f : failures_) {
    if (f.endpoint == endpoint && f.times > 0) {
      --f.times;
      return f.error;
    }
  }
  return 0;
}

std::size_t EmulatedUsbfs::under_way() {
  const std::lock_guard lock(mutex_);
  return in_.size() + out_.size() + held_.size();
}

int EmulatedUsbfs::halts_cleared() {
  const std::lock_guard lock(mutex_);
  return halts_cleared_;
}

int EmulatedUsbfs::submit(usbdevfs_urb* urb) {
  if (unplugged_) return -ENODEV;
  urb->status = -EINPROGRESS;
  if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    control(urb);
  } else if ((urb->endpoint & 0x80) != 0) {
    in_.push_back(urb);
  } else {
    out_.push_back(urb);
  }
  serve();
  return 0;
}

void EmulatedUsbfs::control(usbdevfs_urb* urb) {
  if (hold_control_) {
    held_.push_back(urb);
    return;
  }
  auto* bytes = static_cast<std::byte*>(urb->buffer);
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  const auto word = [&](std::size_t i) {
    return static_cast<std::uint16_t>(byte(i) | byte(i + 1) << 8);
  };
  const ControlRequest request{static_cast<std::uint8_t>(byte(0)),
                               static_cast<std::uint8_t>(byte(1)), word(2), word(4)};
  const std::span<std::byte> data(bytes + kSetupBytes, word(6));
  const bool is_in = (request.type & 0x80) != 0;
  device_.advance_to(clock_.now_ns());
  IoResult result;
  if (is_in && request.request == 6 && request.type == 0x80 && request.value == 0x0200) {
    // The configuration descriptor is the bus's, not the model's.
    const std::size_t length = std::min(data.size(), descriptors_.size() - kDeviceDescriptorBytes);
    std::memcpy(data.data(), descriptors_.data() + kDeviceDescriptorBytes, length);
    result.bytes = length;
  } else {
    result = is_in ? device_.control_in(request, data) : device_.control_out(request, data);
  }
  const std::size_t moved = is_in ? result.bytes : data.size();
  complete(urb, result.ok() ? 0 : -EPIPE, result.ok() ? static_cast<int>(moved) : 0);
}

int EmulatedUsbfs::discard(usbdevfs_urb* urb) {
  for (auto* queue : {&in_, &out_, &held_}) {
    const auto found = std::find(queue->begin(), queue->end(), urb);
    if (found == queue->end()) continue;
    queue->erase(found);
    complete(urb, -ENOENT, 0);
    return 0;
  }
  return -EINVAL;
}

int EmulatedUsbfs::reap(usbdevfs_urb** out) {
  if (done_.empty()) return unplugged_ ? -ENODEV : -EAGAIN;
  *out = done_.front();
  done_.pop_front();
  if (done_.empty()) signal(false);
  return 0;
}

void EmulatedUsbfs::complete(usbdevfs_urb* urb, int status, int length) {
  urb->status = status;
  urb->actual_length = length;
  done_.push_back(urb);
  signal(true);
}

void EmulatedUsbfs::signal(bool something_to_reap) {
  if (signalled_ == something_to_reap || pipe_[0] < 0) return;
  signalled_ = something_to_reap;
  std::vector<char> page(static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
  const long moved = something_to_reap ? ::syscall(SYS_read, pipe_[0], page.data(), page.size())
                                       : ::syscall(SYS_write, pipe_[1], page.data(), page.size());
  if (moved != static_cast<long>(page.size())) std::abort();
}

int EmulatedUsbfs::on_ioctl(unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  switch (request) {
    case USBDEVFS_CONNECTINFO:
      *static_cast<usbdevfs_connectinfo*>(argument) = {2, 0};
      return 0;
    case USBDEVFS_GET_SPEED:
      return kHighSpeed;
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<std::uint32_t*>(argument) = USBDEVFS_CAP_ZERO_PACKET |
                                               USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                               USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_CONTROL: {  // libusb asks for the present configuration
      auto* transfer = static_cast<usbdevfs_ctrltransfer*>(argument);
      if (transfer->bRequest != 8 || transfer->wLength < 1) return -EPIPE;
      *static_cast<std::uint8_t*>(transfer->data) = 1;
      return 1;
    }
    case USBDEVFS_SETINTERFACE: {
      const auto* wanted = static_cast<usbdevfs_setinterface*>(argument);
      const ControlRequest set{0x01, 0x0b, static_cast<std::uint16_t>(wanted->altsetting),
                               static_cast<std::uint16_t>(wanted->interface)};
      return device_.control_out(set, {}).ok() ? 0 : -EPIPE;
    }
    case USBDEVFS_CLEAR_HALT:
      ++halts_cleared_;
      return unplugged_ ? -ENODEV : 0;
    case USBDEVFS_SUBMITURB:
      return submit(static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_DISCARDURB:
      return discard(static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_REAPURBNDELAY:
      return reap(static_cast<usbdevfs_urb**>(argument));
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
      return unplugged_ ? -ENODEV : 0;
    default:
      return -ENOTTY;
  }
}

long EmulatedUsbfs::on_read(void* out, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const std::size_t length = std::min(bytes, descriptors_.size() - read_at_);
  std::memcpy(out, descriptors_.data() + read_at_, length);
  read_at_ += length;
  return static_cast<long>(length);
}

long EmulatedUsbfs::on_seek(long offset) {
  const std::lock_guard lock(mutex_);
  read_at_ = static_cast<std::size_t>(offset);
  return offset;
}

EmulatedUsbfs* usbfs_of(int fd) {
  EmulatedUsbfs* usbfs = g_usbfs;
  return usbfs != nullptr && usbfs->descriptor() == fd ? usbfs : nullptr;
}

long with_errno(long result) {
  if (result >= 0) return result;
  errno = static_cast<int>(-result);
  return -1;
}

}  // namespace palpate::hal::test
