// SPDX-License-Identifier: Apache-2.0
#include "hal/transport/transport.hpp"

#include "hal/text_table.hpp"

namespace palpate::hal {

const char* describe(IoStatus status) noexcept {
  return text_in<IoStatus>({{IoStatus::ok, "done"},
                            {IoStatus::timed_out, "no answer in time"},
                            {IoStatus::stalled, "refused by the device"},
                            {IoStatus::lost, "the device is gone"},
                            {IoStatus::failed, "the transfer failed"}},
                           status, "unknown");
}

}  // namespace palpate::hal
