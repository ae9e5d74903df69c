// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/file_flash.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace palpate::hal::flash {
namespace {

/// Closes itself: the mapping stays.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

[[noreturn]] void fail(int error, const std::filesystem::path& file) {
  throw std::system_error(error, std::generic_category(), file.string());
}

}  // namespace

FileFlash::FileFlash(const std::filesystem::path& file, const SlotLayout& layout)
    : layout_(layout), size_(layout.flash_bytes()) {
  const Descriptor open{::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)};
  struct stat status {};
  if (open.fd < 0 || ::fstat(open.fd, &status) != 0) fail(errno, file);
  const bool is_new = status.st_size == 0;
  if (is_new && ::ftruncate(open.fd, static_cast<off_t>(size_)) != 0) fail(errno, file);
  if (!is_new && static_cast<std::size_t>(status.st_size) != size_) fail(EINVAL, file);
  void* mapped = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, open.fd, 0);
  if (mapped == MAP_FAILED) fail(errno, file);
  memory_ = static_cast<std::byte*>(mapped);
  if (is_new) std::fill_n(memory_, size_, kErased);
}

FileFlash::~FileFlash() { ::munmap(memory_, size_); }

bool FileFlash::erase(std::uint32_t offset) noexcept {
  if (offset % layout_.erase_bytes != 0 || offset >= size_) return false;
  std::fill_n(memory_ + offset, layout_.erase_bytes, kErased);
  return store(offset, layout_.erase_bytes);
}

bool FileFlash::program(std::uint32_t offset, std::span<const std::byte> bytes) noexcept {
  if (offset % kProgramBytes != 0 || offset + bytes.size() > size_) return false;
  const auto target = std::span(memory_ + offset, bytes.size());
  if (!std::all_of(target.begin(), target.end(), [](std::byte b) { return b == kErased; })) {
    return false;
  }
  std::copy(bytes.begin(), bytes.end(), target.begin());
  return store(offset, bytes.size());
}

bool FileFlash::store(std::uint32_t offset, std::size_t length) noexcept {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t from = offset / page * page;
  return ::msync(memory_ + from, offset - from + length, MS_SYNC) == 0;
}

}  // namespace palpate::hal::flash
