// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const fs::path& where, int error) {
  throw Failure(kOther, what + " (" + std::generic_category().message(error) + ")", where.string(),
                "give a place that exists, is writable and has room");
}

/// Closes on every way out; close() reports what a delayed write may still say.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

[[nodiscard]] bool write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

/// Opens a new file in the folder, under a name that nobody else uses.
int create_temporary(const fs::path& folder, fs::path& out_path) {
  for (unsigned n = 0;; ++n) {
    out_path =
        folder / (".palpate-" + std::to_string(::getpid()) + "-" + std::to_string(n) + ".tmp");
    const int fd = ::open(out_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
}

}  // namespace

OutputFile::OutputFile(fs::path target, std::span<const std::byte> bytes)
    : target_(std::move(target)), bytes_(bytes) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) fail("cannot write the file", target_, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) return;
  if (fs::is_symlink(fs::symlink_status(target_, ignored))) {
    target_ = fs::weakly_canonical(target_);
  }

  fs::path temporary;
  Descriptor file(create_temporary(target_.parent_path(), temporary));
  if (file.get() < 0) fail("cannot create the file", target_, errno);
  if (!write_all(file.get(), bytes_) || ::fsync(file.get()) != 0 || !file.close()) {
    const int error = errno;
    ::unlink(temporary.c_str());
    fail("cannot write the file", target_, error);
  }
  temporary_ = std::move(temporary);
}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::commit() {
  if (temporary_.empty()) {
    Descriptor file(::open(target_.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0 || !write_all(file.get(), bytes_) || !file.close()) {
      fail("cannot write the file", target_, errno);
    }
    return;
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail("cannot rename the file", target_, errno);
  }
  temporary_.clear();
  // The new name survives a power cut only once the folder is on the disk. Not every file system
  // can sync a folder: the file is whole either way.
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() >= 0) ::fsync(directory.get());
}

}  // namespace palpate::cli
