// SPDX-License-Identifier: Apache-2.0
// One open file of an emulated usbfs.
//
// libusb is given the writing end of a pipe of one page. While the pipe is full there is nothing to
// reap; drained, it is ready for writing, which is how usbfs says that a transfer has completed;
// with the reading end closed it reports an error, which is how usbfs says that the device is gone.
#pragma once

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <deque>
#include <set>
#include <vector>

struct usbdevfs_urb;

namespace palpate::hal::test {

class UsbfsFile {
 public:
  UsbfsFile() {
    if (::pipe(pipe_) != 0) std::abort();
    ::fcntl(pipe_[1], F_SETPIPE_SZ, page());
    ::fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
    signal(false);
  }
  ~UsbfsFile() {
    die();
    close_end(pipe_[1]);
  }
  UsbfsFile(const UsbfsFile&) = delete;
  UsbfsFile& operator=(const UsbfsFile&) = delete;
  UsbfsFile(UsbfsFile&&) = delete;
  UsbfsFile& operator=(UsbfsFile&&) = delete;

  [[nodiscard]] int descriptor() const noexcept { return pipe_[1]; }

  /// The device has left the bus.
  void die() { close_end(pipe_[0]); }
  [[nodiscard]] bool dead() const noexcept { return pipe_[0] < 0; }

  void signal(bool something_to_reap) {
    if (signalled_ == something_to_reap || dead()) return;
    signalled_ = something_to_reap;
    std::vector<char> bytes(static_cast<std::size_t>(page()));
    const long moved = something_to_reap
                           ? ::syscall(SYS_read, pipe_[0], bytes.data(), bytes.size())
                           : ::syscall(SYS_write, pipe_[1], bytes.data(), bytes.size());
    if (moved != static_cast<long>(bytes.size())) std::abort();
  }

  std::set<unsigned> claims;  ///< interfaces
  std::deque<usbdevfs_urb*> done;
  std::size_t read_at = 0;

 private:
  static int page() { return static_cast<int>(::sysconf(_SC_PAGESIZE)); }
  /// Past whoever interposes on close().
  static void close_end(int& fd) {
    if (fd >= 0) ::syscall(SYS_close, fd);
    fd = -1;
  }

  int pipe_[2] = {-1, -1};
  bool signalled_ = true;  ///< the pipe is drained
};

}  // namespace palpate::hal::test
