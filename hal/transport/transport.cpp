// SPDX-License-Identifier: Apache-2.0
#include "hal/transport/transport.hpp"

namespace palpate::hal {

const char* describe(IoStatus status) noexcept {
  switch (status) {
    case IoStatus::ok:
      return "done";
    case IoStatus::timed_out:
      return "no answer in time";
    case IoStatus::stalled:
      return "refused by the device";
    case IoStatus::lost:
      return "the device is gone";
    case IoStatus::failed:
      return "the transfer failed";
  }
  return "unknown";
}

}  // namespace palpate::hal
