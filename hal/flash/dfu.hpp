// SPDX-License-Identifier: Apache-2.0
// Names and numbers of USB DFU 1.1 (USB-IF, "Device Class Specification for Device Firmware
// Upgrade", 2004), for both ends. Freestanding.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::hal::flash {

inline constexpr std::uint8_t kDfuClass = 0xfe;
inline constexpr std::uint8_t kDfuSubclass = 0x01;
inline constexpr std::uint8_t kDfuModeProtocol = 0x02;
inline constexpr std::uint8_t kDfuOut = 0x21;  ///< bmRequestType: class, interface
inline constexpr std::uint8_t kDfuIn = 0xa1;
inline constexpr std::uint8_t kFunctionalDescriptorType = 0x21;
inline constexpr std::size_t kFunctionalDescriptorBytes = 9;
inline constexpr std::size_t kStatusReplyBytes = 6;

/// bRequest.
enum class DfuRequest : std::uint8_t {
  detach = 0,
  download = 1,  ///< wValue: block
  upload = 2,    ///< wValue: block
  get_status = 3,
  clear_status = 4,
  get_state = 5,
  abort = 6
};

enum class DfuState : std::uint8_t {
  app_idle = 0,
  app_detach = 1,
  idle = 2,
  download_sync = 3,
  download_busy = 4,
  download_idle = 5,
  manifest_sync = 6,
  manifest = 7,
  manifest_wait_reset = 8,
  upload_idle = 9,
  error = 10
};

enum class DfuStatus : std::uint8_t {
  ok = 0x0,
  target = 0x1,  ///< not for use by this device: an engine for it needs more memory
  file = 0x2,    ///< not signed with the device's key
  write = 0x3,
  erase = 0x4,
  check_erased = 0x5,
  program = 0x6,
  verify = 0x7,   ///< what was written is not a sound image
  address = 0x8,  ///< beyond the slot, or the slot is in use
  not_done = 0x9,
  firmware = 0xa,
  vendor = 0xb,  ///< older than what the device has confirmed, by its security counter
  usb_reset = 0xc,
  power_on_reset = 0xd,
  unknown = 0xe,
  stalled = 0xf  ///< a request that makes no sense now
};

/// bmAttributes of the functional descriptor.
enum DfuAttribute : std::uint8_t {
  kCanDownload = 1,
  kCanUpload = 2,
  kManifestationTolerant = 4,
  kWillDetach = 8
};

}  // namespace palpate::hal::flash
