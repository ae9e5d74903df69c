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

namespace palpate::hal::test {
namespace {

std::array<std::atomic<EmulatedUsbfs*>, EmulatedUsbfs::kMost> g_usbfs{};

constexpr std::uint64_t kLookEvery_ns = 100'000;
constexpr std::size_t kSetupBytes = 8;
constexpr int kHardwarePriority = 90;

/// As usbfs gives them to who reads the file.
std::vector<std::uint8_t> file_of(const simulator::UsbDescriptors& descriptors) {
  std::vector<std::uint8_t> all = descriptors.device;
  all.insert(all.end(), descriptors.configuration.begin(), descriptors.configuration.end());
  return all;
}

}  // namespace

EmulatedUsbfs::EmulatedUsbfs(simulator::SimulatedDevice& device)
    : device_(device), descriptors_(file_of(device.descriptors())) {
  if (::pipe(pipe_) != 0) std::abort();
  const int page = static_cast<int>(::sysconf(_SC_PAGESIZE));
  ::fcntl(pipe_[1], F_SETPIPE_SZ, page);
  ::fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
  signal(false);
  for (auto& place : g_usbfs) {
    EmulatedUsbfs* nobody = nullptr;
    if (place.compare_exchange_strong(nobody, this)) break;
  }
  thread_ = std::thread([this] { live(); });
}

EmulatedUsbfs::~EmulatedUsbfs() {
  stopping_ = true;
  thread_.join();
  for (auto& place : g_usbfs) {
    EmulatedUsbfs* me = this;
    if (place.compare_exchange_strong(me, nullptr)) break;
  }
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
  pull_plug();
}

void EmulatedUsbfs::unplug_after(int submissions) {
  const std::lock_guard lock(mutex_);
  submissions_left_ = submissions;
}

void EmulatedUsbfs::refuse_claims(int error) {
  const std::lock_guard lock(mutex_);
  claim_result_ = error;
}

void EmulatedUsbfs::pull_plug() {
  if (unplugged_) return;
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
  if (submissions_left_ == 0) pull_plug();
  if (unplugged_) return -ENODEV;
  if (submissions_left_ > 0) --submissions_left_;
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
  const IoResult result =
      is_in ? device_.control_in(request, data) : device_.control_out(request, data);
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
      return static_cast<int>(device_.descriptors().speed);
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
    case USBDEVFS_DISCONNECT_CLAIM:
      return unplugged_ ? -ENODEV : claim_result_;
    case USBDEVFS_RELEASEINTERFACE:
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
  for (EmulatedUsbfs* usbfs : g_usbfs) {
    if (usbfs != nullptr && usbfs->descriptor() == fd) return usbfs;
  }
  return nullptr;
}

long with_errno(long result) {
  if (result >= 0) return result;
  errno = static_cast<int>(-result);
  return -1;
}

}  // namespace palpate::hal::test
