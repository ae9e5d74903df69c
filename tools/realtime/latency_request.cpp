// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/latency_request.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace palpate::realtime {

LatencyRequest::LatencyRequest() noexcept
    : file_(::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
  constexpr std::int32_t kLatency_us = 0;
  granted_ = file_ < 0 ? errno == ENOENT
                       : ::write(file_, &kLatency_us, sizeof kLatency_us) == sizeof kLatency_us;
}

LatencyRequest::~LatencyRequest() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace palpate::realtime
