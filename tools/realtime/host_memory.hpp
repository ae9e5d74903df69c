// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the process's memory ready: no page of it faults while this lives.
#pragma once

#include <string>

namespace palpate::realtime {

/// Locks every page that the process has mapped (mlockall). Where that is not permitted, maps them
/// at least (madvise with MADV_POPULATE, Linux 5.14): then only memory pressure can make them
/// fault.
class HostMemory {
 public:
  /// Allocates; takes as long as the mapping of what is not there yet.
  HostMemory();
  ~HostMemory();
  HostMemory(const HostMemory&) = delete;
  HostMemory& operator=(const HostMemory&) = delete;
  HostMemory(HostMemory&&) = delete;
  HostMemory& operator=(HostMemory&&) = delete;

  [[nodiscard]] bool locked() const noexcept { return locked_; }

  /// Why memory is not locked, and the fix; empty where it is.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

 private:
  bool locked_ = false;
  std::string problem_;
};

}  // namespace palpate::realtime
