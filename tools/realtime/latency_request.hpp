// SPDX-License-Identifier: GPL-3.0-or-later
// Asks the kernel to keep processors out of sleep states that take long to leave, for as long as
// this lives. Source: Linux documentation, power/pm_qos_interface: the request lives as long as the
// open file.
#pragma once

namespace palpate::realtime {

class LatencyRequest {
 public:
  /// Never fails: see granted().
  LatencyRequest() noexcept;
  ~LatencyRequest();
  LatencyRequest(const LatencyRequest&) = delete;
  LatencyRequest& operator=(const LatencyRequest&) = delete;
  LatencyRequest(LatencyRequest&&) = delete;
  LatencyRequest& operator=(LatencyRequest&&) = delete;

  /// True also where the kernel has no such file: then there are no sleep states to keep out of.
  [[nodiscard]] bool granted() const noexcept { return granted_; }

 private:
  int file_ = -1;
  bool granted_ = false;
};

}  // namespace palpate::realtime
