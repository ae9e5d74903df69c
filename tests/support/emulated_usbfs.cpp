// SPDX-License-Identifier: Apache-2.0
#include "emulated_usbfs.hpp"

#include <linux/usbdevice_fs.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "usb_configuration.hpp"

namespace palpate::hal::test {
namespace {

/// Whose a file descriptor is.
std::array<std::atomic<EmulatedUsbfs*>, 1024> g_usbfs_of{};

constexpr std::uint64_t kLookEvery_ns = 100'000;
constexpr std::size_t kSetupBytes = 8;
constexpr int kHardwarePriority = 90;

/// As usbfs gives them to who reads the file.
std::vector<std::uint8_t> bytes_of(const simulator::UsbDescriptors& descriptors) {
  std::vector<std::uint8_t> all = descriptors.device;
  all.insert(all.end(), descriptors.configuration.begin(), descriptors.configuration.end());
  return all;
}

unsigned byte_at(const std::byte* setup, std::size_t i) {
  return std::to_integer<unsigned>(setup[i]);
}
std::uint16_t word_at(const std::byte* setup, std::size_t i) {
  return static_cast<std::uint16_t>(byte_at(setup, i) | byte_at(setup, i + 1) << 8);
}

}  // namespace

EmulatedUsbfs::EmulatedUsbfs(simulator::SimulatedDevice& device)
    : device_(device), descriptors_(bytes_of(device.descriptors())) {
  thread_ = std::thread([this] { live(); });
}

EmulatedUsbfs::~EmulatedUsbfs() {
  stopping_ = true;
  thread_.join();
  while (!files_.empty()) close(files_.front()->descriptor());
}

int EmulatedUsbfs::open() {
  const std::lock_guard lock(mutex_);
  device_.advance_to(clock_.now_ns());
  serve();
  if (unplugged_ || !device_.presence().on_bus) return -ENODEV;
  const auto& file = files_.emplace_back(std::make_unique<UsbfsFile>());
  const int fd = file->descriptor();
  if (static_cast<std::size_t>(fd) >= g_usbfs_of.size()) std::abort();
  g_usbfs_of[static_cast<std::size_t>(fd)] = this;
  return fd;
}

void EmulatedUsbfs::close(int fd) {
  const std::lock_guard lock(mutex_);
  const auto mine = std::find_if(files_.begin(), files_.end(),
                                 [&](const auto& file) { return file->descriptor() == fd; });
  if (mine == files_.end()) return;
  cancel_all(**mine, -ENOENT);
  g_usbfs_of[static_cast<std::size_t>(fd)] = nullptr;
  files_.erase(mine);
}

UsbfsFile* EmulatedUsbfs::file_of(int fd) {
  for (const auto& file : files_) {
    if (file->descriptor() == fd) return file.get();
  }
  return nullptr;
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
  if (const std::uint32_t times = device_.presence().times_left; times != times_left_) {
    times_left_ = times;
    pull_plug();
  }
  if (unplugged_) return;
  while (!out_.empty() && !hold_out_) {
    const Transfer next = out_.front();
    out_.pop_front();
    const int error = failure_of(next.urb->endpoint);
    if (error == 0) {
      device_.out({static_cast<const std::byte*>(next.urb->buffer),
                   static_cast<std::size_t>(next.urb->buffer_length)});
    }
    complete(next, error, error == 0 ? next.urb->buffer_length : 0);
  }
  while (!in_.empty()) {
    const Transfer next = in_.front();
    const int error = failure_of(next.urb->endpoint);
    std::array<std::byte, 512> bytes;
    const std::size_t length = error == 0 ? device_.in(bytes) : 0;
    if (length == 0 && error == 0) break;
    in_.pop_front();
    const auto room = static_cast<std::size_t>(next.urb->buffer_length);
    std::memcpy(next.urb->buffer, bytes.data(), std::min(length, room));
    const int status = length > room ? -EOVERFLOW : error;
    complete(next, status, static_cast<int>(std::min(length, room)));
  }
}

void EmulatedUsbfs::unplug() {
  const std::lock_guard lock(mutex_);
  unplugged_ = true;
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

/// Files that were open are of no use any more.
void EmulatedUsbfs::pull_plug() {
  device_.bus_reset();
  for (const auto& file : files_) {
    if (file->dead()) continue;
    cancel_all(*file, -ESHUTDOWN);
    file->die();
  }
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

/// One file has an interface at a time; whoever has it may claim it again.
int EmulatedUsbfs::claim(UsbfsFile& file, unsigned interface) {
  if (!has_interface(device_.descriptors().configuration, interface)) return -ENOENT;
  if (claim_result_ != 0) return claim_result_;
  const bool taken = std::any_of(files_.begin(), files_.end(), [&](const auto& other) {
    return other.get() != &file && !other->dead() && other->claims.count(interface) > 0;
  });
  if (taken) return -EBUSY;
  file.claims.insert(interface);
  return 0;
}

/// As the kernel does it, which claims for who has not asked.
int EmulatedUsbfs::claim_for_endpoint(UsbfsFile& file, std::uint8_t address) {
  const auto interface = interface_of(device_.descriptors().configuration, address);
  return interface ? claim(file, *interface) : -ENOENT;
}

/// Requests to an interface are for who has it, but for those of the device's maker.
int EmulatedUsbfs::claim_for_control(UsbfsFile& file, const std::byte* setup) {
  constexpr unsigned kVendor = 0x40, kType = 0x60, kRecipient = 0x1f;
  const unsigned type = byte_at(setup, 0), index = byte_at(setup, 4);
  if ((type & kType) == kVendor) return 0;
  if ((type & kRecipient) == 1) return claim(file, index);
  if ((type & kRecipient) == 2) return claim_for_endpoint(file, static_cast<std::uint8_t>(index));
  return 0;
}

int EmulatedUsbfs::set_alternate(UsbfsFile& file, unsigned interface, int setting) {
  if (const int refused = claim(file, interface); refused != 0) return refused;
  const ControlRequest set{0x01, 0x0b, static_cast<std::uint16_t>(setting),
                           static_cast<std::uint16_t>(interface)};
  return device_.control_out(set, {}).ok() ? 0 : -EPIPE;
}

int EmulatedUsbfs::submit(UsbfsFile& file, usbdevfs_urb* urb) {
  if (submissions_left_ == 0) {
    unplugged_ = true;
    pull_plug();
  }
  if (file.dead()) return -ENODEV;
  if (submissions_left_ > 0) --submissions_left_;
  const bool is_control = urb->type == USBDEVFS_URB_TYPE_CONTROL;
  const auto* setup = static_cast<const std::byte*>(urb->buffer);
  const auto length = static_cast<std::size_t>(urb->buffer_length);
  if (is_control && (length < kSetupBytes || length < kSetupBytes + word_at(setup, 6))) {
    return -EINVAL;
  }
  const int refused =
      is_control ? claim_for_control(file, setup) : claim_for_endpoint(file, urb->endpoint);
  if (refused != 0) return refused;
  urb->status = -EINPROGRESS;
  if (is_control) {
    control({urb, &file});
  } else {
    ((urb->endpoint & 0x80) != 0 ? in_ : out_).push_back({urb, &file});
  }
  serve();
  return 0;
}

void EmulatedUsbfs::control(const Transfer& transfer) {
  if (hold_control_) {
    held_.push_back(transfer);
    return;
  }
  auto* setup = static_cast<std::byte*>(transfer.urb->buffer);
  const ControlRequest request{static_cast<std::uint8_t>(byte_at(setup, 0)),
                               static_cast<std::uint8_t>(byte_at(setup, 1)), word_at(setup, 2),
                               word_at(setup, 4)};
  const std::span<std::byte> data(setup + kSetupBytes, word_at(setup, 6));
  const bool is_in = (request.type & 0x80) != 0;
  device_.advance_to(clock_.now_ns());
  const IoResult result =
      is_in ? device_.control_in(request, data) : device_.control_out(request, data);
  const std::size_t moved = is_in ? result.bytes : data.size();
  complete(transfer, result.ok() ? 0 : -EPIPE, result.ok() ? static_cast<int>(moved) : 0);
}

int EmulatedUsbfs::discard(UsbfsFile& file, usbdevfs_urb* urb) {
  for (auto* queue : {&in_, &out_, &held_}) {
    const auto found = std::find_if(queue->begin(), queue->end(), [&](const Transfer& transfer) {
      return transfer.urb == urb && transfer.file == &file;
    });
    if (found == queue->end()) continue;
    queue->erase(found);
    complete({urb, &file}, -ENOENT, 0);
    return 0;
  }
  return -EINVAL;
}

void EmulatedUsbfs::cancel_all(const UsbfsFile& file, int status) {
  for (auto* queue : {&in_, &out_, &held_}) {
    std::deque<Transfer> kept;
    for (const Transfer& transfer : *queue) {
      if (transfer.file == &file) {
        complete(transfer, status, 0);
      } else {
        kept.push_back(transfer);
      }
    }
    queue->swap(kept);
  }
}

int EmulatedUsbfs::reap(UsbfsFile& file, usbdevfs_urb** out) {
  if (file.done.empty()) return file.dead() ? -ENODEV : -EAGAIN;
  *out = file.done.front();
  file.done.pop_front();
  if (file.done.empty()) file.signal(false);
  return 0;
}

void EmulatedUsbfs::complete(const Transfer& transfer, int status, int length) {
  transfer.urb->status = status;
  transfer.urb->actual_length = length;
  transfer.file->done.push_back(transfer.urb);
  transfer.file->signal(true);
}

int EmulatedUsbfs::on_ioctl(int fd, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  UsbfsFile* file = file_of(fd);
  if (file == nullptr) return -EBADF;
  if (request == USBDEVFS_REAPURBNDELAY) {
    return reap(*file, static_cast<usbdevfs_urb**>(argument));
  }
  if (request == USBDEVFS_DISCARDURB) return discard(*file, static_cast<usbdevfs_urb*>(argument));
  return file->dead() ? -ENODEV : request_of(*file, request, argument);
}

/// Of a device that is there.
int EmulatedUsbfs::request_of(UsbfsFile& file, unsigned long request, void* argument) {
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
      return set_alternate(file, wanted->interface, static_cast<int>(wanted->altsetting));
    }
    case USBDEVFS_CLEAR_HALT:
      ++halts_cleared_;
      return claim_for_endpoint(file, static_cast<std::uint8_t>(*static_cast<unsigned*>(argument)));
    case USBDEVFS_SUBMITURB:
      return submit(file, static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_CLAIMINTERFACE:
      return claim(file, *static_cast<const unsigned*>(argument));
    case USBDEVFS_DISCONNECT_CLAIM:
      return claim(file, static_cast<const usbdevfs_disconnect_claim*>(argument)->interface);
    case USBDEVFS_RELEASEINTERFACE:
      return file.claims.erase(*static_cast<const unsigned*>(argument)) > 0 ? 0 : -EINVAL;
    default:
      return -ENOTTY;
  }
}

long EmulatedUsbfs::on_read(int fd, void* out, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  UsbfsFile* file = file_of(fd);
  if (file == nullptr || file->dead()) return -ENODEV;
  const std::size_t length = std::min(bytes, descriptors_.size() - file->read_at);
  std::memcpy(out, descriptors_.data() + file->read_at, length);
  file->read_at += length;
  return static_cast<long>(length);
}

long EmulatedUsbfs::on_seek(int fd, long offset) {
  const std::lock_guard lock(mutex_);
  UsbfsFile* file = file_of(fd);
  if (file == nullptr) return -EBADF;
  file->read_at = static_cast<std::size_t>(offset);
  return offset;
}

EmulatedUsbfs* usbfs_of(int fd) {
  const auto place = static_cast<std::size_t>(fd);
  return fd >= 0 && place < g_usbfs_of.size() ? g_usbfs_of[place].load() : nullptr;
}

long with_errno(long result) {
  if (result >= 0) return result;
  errno = static_cast<int>(-result);
  return -1;
}

}  // namespace palpate::hal::test
