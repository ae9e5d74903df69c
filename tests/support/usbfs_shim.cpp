// SPDX-License-Identifier: Apache-2.0
// A simulated device of the open protocol for any program that uses libusb: to be preloaded.
// Opening /dev/bus/usb/001/002 reaches it; that there is such a device must come from elsewhere
// (umockdev). Its flash is the file named by PALPATE_SHIM_FLASH.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/types.h>

#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "emulated_usbfs.hpp"
#include "hal/flash/file_flash.hpp"
#include "hal/simulator/open_device.hpp"

namespace palpate::hal::test {
namespace {

constexpr const char* kNode = "/dev/bus/usb/001/002";

struct Shim {
  explicit Shim(const char* flash_file)
      : flash(flash_file, layout), model(options()), usbfs(model, open_device_descriptors()) {}

  simulator::OpenDeviceOptions options() {
    simulator::OpenDeviceOptions out;
    out.flash = &flash;
    out.layout = layout;
    // The hand presses 5 mm towards the scene's centre along x and back, each second.
    out.hand.rest.position_m = {0.0102, 0, 0};
    out.hand.script = {
        {0, {{0.0102, 0, 0}, {}}}, {0.5, {{0.0092, 0, 0}, {}}}, {1, {{0.0102, 0, 0}, {}}}};
    out.capabilities.max_life_us = protocol::kMaxCommandLife_us;
    out.capabilities.max_state_age_us = 1'000'000;
    return out;
  }

  flash::SlotLayout layout{4096, 64};
  flash::FileFlash flash;
  simulator::OpenDevice model;
  EmulatedUsbfs usbfs;
};

/// Made when the device is opened first; lives as long as the process.
Shim* shim() {
  static const auto kShim = []() -> std::unique_ptr<Shim> {
    const char* file = std::getenv("PALPATE_SHIM_FLASH");
    return file == nullptr ? nullptr : std::make_unique<Shim>(file);
  }();
  return kShim.get();
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int open_file(const char* name, const char* path, int flags, va_list arguments) {
  if (std::strcmp(path, kNode) == 0 && shim() != nullptr) return shim()->usbfs.descriptor();
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
  return next<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace
}  // namespace palpate::hal::test

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = palpate::hal::test::open_file("open", path, flags, arguments);
  va_end(arguments);
  return fd;
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = palpate::hal::test::open_file("open64", path, flags, arguments);
  va_end(arguments);
  return fd;
}

int __open_2(const char* path, int flags);
int __open64_2(const char* path, int flags);
int __open_2(const char* path, int flags) { return open(path, flags); }
int __open64_2(const char* path, int flags) { return open64(path, flags); }

int close(int fd) {
  // Whoever opens the device again gets the same descriptor.
  if (palpate::hal::test::usbfs_of(fd) != nullptr) return 0;
  return palpate::hal::test::next<int(int)>("close")(fd);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (auto* usbfs = palpate::hal::test::usbfs_of(fd)) {
    return static_cast<int>(palpate::hal::test::with_errno(usbfs->on_ioctl(request, argument)));
  }
  return palpate::hal::test::next<int(int, unsigned long, void*)>("ioctl")(fd, request, argument);
}
}
