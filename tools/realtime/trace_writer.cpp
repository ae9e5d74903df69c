// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/trace_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

namespace palpate::realtime {
namespace {

// Records go to the file as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kBatch = 1024;                  ///< records moved at once
constexpr std::chrono::milliseconds kDrainEvery(20);  ///< far less than the ring holds

[[noreturn]] void fail(int error) {
  throw std::system_error(error, std::generic_category(), "cannot write the trace");
}

}  // namespace

TraceWriter::TraceWriter(std::filesystem::path target, const std::filesystem::path& scene,
                         double rate_Hz, hal::Ring<TraceRecord>& ring)
    : target_(std::move(target)), ring_(ring), batch_(kBatch) {
  if (std::filesystem::is_directory(target_)) fail(EISDIR);
  temporary_ = target_;
  temporary_ += "." + std::to_string(::getpid()) + ".part";
  file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) fail(errno);

  std::string path = std::filesystem::absolute(scene).string();
  header_.scene_bytes = static_cast<std::uint32_t>(path.size());
  path.resize((path.size() + 7) / 8 * 8, '\0');
  header_.header_bytes = static_cast<std::uint32_t>(sizeof(TraceHeader) + path.size());
  header_.record_bytes = sizeof(TraceRecord);
  header_.rate_Hz = rate_Hz;
  // Counts are not known yet: the header is written again by commit().
  if (!write(&header_, sizeof header_) || !write(path.data(), path.size())) {
    const int error = error_;
    ::close(file_);
    ::unlink(temporary_.c_str());
    fail(error);
  }
  thread_ = std::thread([this] { drain_until_stopped(); });
}

TraceWriter::~TraceWriter() {
  stop_thread();
  if (file_ < 0) return;
  ::close(file_);
  ::unlink(temporary_.c_str());
}

void TraceWriter::commit() {
  stop_thread();
  header_.dropped = ring_.dropped();
  if (error_ == 0 && (::lseek(file_, 0, SEEK_SET) != 0 || !write(&header_, sizeof header_) ||
                      ::fsync(file_) != 0 || ::rename(temporary_.c_str(), target_.c_str()) != 0)) {
    error_ = errno;
  }
  if (error_ != 0) fail(error_);
  ::close(std::exchange(file_, -1));
}

void TraceWriter::drain_until_stopped() noexcept {
  while (!stopping_.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(kDrainEvery);
    while (drain()) {
    }
  }
  while (drain()) {
  }
}

/// One batch; false where the ring is empty. Goes on emptying it after a failed write, so that the
/// error is the one that is reported.
bool TraceWriter::drain() noexcept {
  const std::size_t count = ring_.pop(batch_);
  if (error_ == 0 && write(batch_.data(), count * sizeof(TraceRecord))) header_.records += count;
  return count > 0;
}

bool TraceWriter::write(const void* bytes, std::size_t count) noexcept {
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file_, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error_ = errno;
      return false;
    }
    at += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

void TraceWriter::stop_thread() noexcept {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

}  // namespace palpate::realtime
