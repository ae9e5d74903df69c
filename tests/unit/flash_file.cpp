// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/file_flash.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate::hal::flash {
namespace {

using palpate::test::TemporaryFolder;

constexpr SlotLayout kFileLayout{512, 8};

TEST(FileFlash, new_file_is_erased_and_of_full_size) {
  const TemporaryFolder folder;
  const FileFlash flash(folder.path() / "flash", kFileLayout);
  EXPECT_EQ(flash.bytes().size(), kFileLayout.flash_bytes());
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "flash"), flash.bytes().size());
  for (const std::byte b : flash.bytes()) ASSERT_EQ(b, std::byte{0xff});
}

TEST(FileFlash, image_outlives_the_process_that_wrote_it) {
  const TemporaryFolder folder;
  const auto image = palpate::test::seal(
      palpate::test::parts_of({palpate::test::triangle_part({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}));
  {
    FileFlash flash(folder.path() / "flash", kFileLayout);
    Slots slots(flash, kFileLayout);
    ASSERT_EQ(slots.begin(1), UpdateStatus::ok);
    ASSERT_EQ(slots.write(image), UpdateStatus::ok);
    ASSERT_EQ(slots.finish(), UpdateStatus::ok);
  }
  FileFlash flash(folder.path() / "flash", kFileLayout);
  Slots slots(flash, kFileLayout);
  ASSERT_EQ(slots.start(), 1);
  const auto held = slots.state(1).image;
  EXPECT_TRUE(std::equal(held.begin(), held.end(), image.begin(), image.end()));
}

TEST(FileFlash, what_is_not_erased_or_not_there_is_not_written) {
  const TemporaryFolder folder;
  FileFlash flash(folder.path() / "flash", kFileLayout);
  const std::array<std::byte, kProgramBytes> unit{};
  EXPECT_TRUE(flash.program(64, unit));
  EXPECT_FALSE(flash.program(64, unit));
  EXPECT_FALSE(flash.program(7, unit));
  EXPECT_FALSE(flash.program(kFileLayout.flash_bytes(), unit));
  EXPECT_FALSE(flash.erase(100));
  EXPECT_FALSE(flash.erase(kFileLayout.flash_bytes()));
  EXPECT_TRUE(flash.erase(0));
  EXPECT_TRUE(flash.program(64, unit));
}

TEST(FileFlash, file_of_another_size_or_no_place_for_one_is_refused) {
  const TemporaryFolder folder;
  const auto file = folder.write("flash", "short");
  EXPECT_THROW(FileFlash(file, kFileLayout), std::system_error);
  EXPECT_EQ(palpate::test::read_file(file), "short");
  EXPECT_THROW(FileFlash(folder.path() / "none" / "flash", kFileLayout), std::system_error);
}

}  // namespace
}  // namespace palpate::hal::flash
