// SPDX-License-Identifier: Apache-2.0
// The system calls that libusb makes, answered by an emulated usbfs. Linked into a test: the
// executable's definitions come before the C library's, for libusb too.
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>

#include "emulated_usbfs.hpp"

using palpate::hal::test::usbfs_of;
using palpate::hal::test::with_errno;

extern "C" {

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (auto* usbfs = usbfs_of(fd)) {
    return static_cast<int>(with_errno(usbfs->on_ioctl(fd, request, argument)));
  }
  return static_cast<int>(::syscall(SYS_ioctl, fd, request, argument));
}

ssize_t read(int fd, void* out, std::size_t bytes) {
  if (auto* usbfs = usbfs_of(fd)) return usbfs->on_read(fd, out, bytes);
  return ::syscall(SYS_read, fd, out, bytes);
}

off_t lseek(int fd, off_t offset, int whence) noexcept {
  if (auto* usbfs = usbfs_of(fd)) return usbfs->on_seek(fd, offset);
  return ::syscall(SYS_lseek, fd, offset, whence);
}

off64_t lseek64(int fd, off64_t offset, int whence) noexcept { return lseek(fd, offset, whence); }
}
