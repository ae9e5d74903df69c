// SPDX-License-Identifier: GPL-3.0-or-later
// Takes records out of the loop's ring and writes them to a file, on a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>
#include <vector>

#include "hal/ring.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::realtime {

/// The file appears under its name whole, by commit(), or not at all: until then it grows beside it
/// under a temporary name, which the destructor removes.
class TraceWriter {
 public:
  /// Creates the temporary file and starts the thread. The ring must outlive this. Throws
  /// std::system_error.
  TraceWriter(std::filesystem::path target, const std::filesystem::path& scene, double rate_Hz,
              hal::Ring<TraceRecord>& ring);
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;
  TraceWriter(TraceWriter&&) = delete;
  TraceWriter& operator=(TraceWriter&&) = delete;

  /// After the loop has ended: writes what is left in the ring and the header, syncs and renames.
  /// Throws std::system_error, also for what failed to be written earlier.
  void commit();

 private:
  void drain_until_stopped() noexcept;
  bool drain() noexcept;
  bool write(const void* bytes, std::size_t count) noexcept;
  void stop_thread() noexcept;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  TraceHeader header_;
  hal::Ring<TraceRecord>& ring_;
  std::vector<TraceRecord> batch_;
  int file_ = -1;
  int error_ = 0;  ///< errno of the first write that failed; read after the thread has ended
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate::realtime
