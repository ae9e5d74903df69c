// SPDX-License-Identifier: Apache-2.0
// What FunctionFS is told of a device. The rest needs a kernel: tools/hil.
#include <gtest/gtest.h>
#include <linux/usb/functionfs.h>

#include <algorithm>
#include <system_error>

#include "hal/functionfs/function_fs.hpp"
#include "hal/simulator/open_device.hpp"

namespace palpate {
namespace {

std::uint32_t u32(const std::vector<std::byte>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::to_integer<std::uint32_t>(bytes.at(at + i)) << (8 * i);
  }
  return value;
}

TEST(FunctionFs, gets_the_interface_and_its_endpoints_for_full_and_for_high_speed) {
  constexpr std::size_t kHead = 20, kInterface = 9, kEndpoint = 7, kInterval = 6;
  constexpr std::size_t kSpeed = kInterface + 2 * kEndpoint;
  const auto bytes =
      hal::functionfs::descriptors_of(hal::simulator::open_device_descriptors("S", false));
  ASSERT_EQ(bytes.size(), kHead + 2 * kSpeed);
  EXPECT_EQ(u32(bytes, 0), std::uint32_t{FUNCTIONFS_DESCRIPTORS_MAGIC_V2});
  EXPECT_EQ(u32(bytes, 4), bytes.size());
  EXPECT_EQ(u32(bytes, 8), std::uint32_t{FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC});
  EXPECT_EQ(u32(bytes, 12), 3u);
  EXPECT_EQ(u32(bytes, 16), 3u);
  // The interval: a frame of 1 ms at full speed, two microframes of 125 us at high speed.
  const std::size_t in = kHead + kInterface + kInterval;
  EXPECT_EQ(bytes[in], std::byte{1});
  EXPECT_EQ(bytes[in + kSpeed], std::byte{2});
  EXPECT_TRUE(std::equal(bytes.begin() + kHead, bytes.begin() + kHead + kInterface,
                         bytes.begin() + kHead + kSpeed));
}

TEST(FunctionFs, without_its_folder_says_what_is_missing) {
  hal::MonotonicClock clock;
  hal::simulator::OpenDevice device({});
  try {
    hal::functionfs::FunctionFs(device, clock, "/nowhere");
    FAIL();
  } catch (const std::system_error& e) {
    EXPECT_EQ(std::string(e.what()).rfind("/nowhere/ep0: ", 0), 0u) << e.what();
  }
}

}  // namespace
}  // namespace palpate
