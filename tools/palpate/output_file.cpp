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

[[noreturn]] void fail_at(const std::string& what, const fs::path& where, int error) {
  throw Failure(kOther, what + " (" + std::generic_category().message(error) + ")", where.string(),
                "give a place that exists, is writable and has room");
}

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

/// The new name survives a power cut only once the folder is on the disk. Not every file system can
/// sync a folder: the file is whole either way.
void sync_folder(const fs::path& folder) {
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

OutputFile::OutputFile(fs::path target) : target_(std::move(target)) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) fail_at("cannot write the file", target_, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    file_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    if (fs::is_symlink(fs::symlink_status(target_, ignored))) {
      target_ = fs::weakly_canonical(target_);
    }
    file_ = create_temporary(target_.parent_path(), temporary_);
  }
  if (file_ < 0) fail_at("cannot create the file", target_, errno);
}

OutputFile::OutputFile(fs::path target, std::span<const std::byte> bytes)
    : OutputFile(std::move(target)) {
  append(bytes);
}

OutputFile::~OutputFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::append(std::span<const std::byte> bytes) {
  if (!write_all(file_, bytes)) fail_at("cannot write the file", target_, errno);
}

void OutputFile::commit() {
  const bool synced = temporary_.empty() || ::fsync(file_) == 0;
  // Some file systems report a failed write only here.
  if (!synced || ::close(std::exchange(file_, -1)) != 0) {
    fail_at("cannot write the file", target_, errno);
  }
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail_at("cannot rename the file", target_, errno);
  }
  temporary_.clear();
  sync_folder(target_.parent_path());
}

void require_writable(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return;
  const OutputFile probe(target);
}

}  // namespace palpate::cli
