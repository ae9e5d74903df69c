// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate devices` and `palpate flash` as processes, on a host that need not have any USB.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate {
namespace {

using nlohmann::json;

class Flash : public testing::Test {
 protected:
  Flash() {
    const auto bytes = test::seal(test::parts_of({test::tetrahedron_part()}));
    image_ = folder_
                 .write("tetrahedron.palp",
                        std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()))
                 .string();
  }
  [[nodiscard]] test::Outcome flash(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {PALPATE_EXECUTABLE, "flash"});
    return test::run(std::move(arguments));
  }
  test::TemporaryFolder folder_;
  std::string image_;
};

TEST(Devices, json_is_a_list_with_the_documented_keys) {
  const test::Outcome outcome = test::run({PALPATE_EXECUTABLE, "devices", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json list = json::parse(outcome.out);
  ASSERT_TRUE(list.is_array());
  for (const json& device : list) {
    for (const char* key : {"kind", "serial", "path", "state", "problem", "mend"}) {
      EXPECT_TRUE(device.contains(key)) << key;
    }
  }
}

TEST(Devices, text_says_something_in_any_case) {
  const test::Outcome outcome = test::run({PALPATE_EXECUTABLE, "devices"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_FALSE(outcome.out.empty());
}

TEST_F(Flash, device_that_is_not_there_is_a_device_error) {
  const test::Outcome outcome = flash({image_, "--device", "usb:no such serial"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(outcome.err.rfind("palpate: error: device failed at ", 0), 0u) << outcome.err;
}

TEST_F(Flash, devices_that_hold_no_images_are_refused) {
  for (const char* device : {"mock", "falcon"}) {
    const test::Outcome outcome = flash({image_, "--device", device});
    EXPECT_EQ(outcome.status, 4);
    EXPECT_NE(outcome.err.find("holds no images"), std::string::npos) << outcome.err;
  }
}

TEST_F(Flash, what_is_no_image_is_refused_before_a_device_is_looked_for) {
  const std::string text = folder_.write("text.palp", "no image").string();
  EXPECT_EQ(flash({text, "--device", "usb"}).status, 3);
}

TEST_F(Flash, wrong_options_are_a_usage_error) {
  EXPECT_EQ(flash({image_}).status, 2);
  EXPECT_EQ(flash({image_, "--device", "pencil"}).status, 2);
  EXPECT_EQ(flash({image_, "--device", "usb", "--slot", "C"}).status, 2);
}

}  // namespace
}  // namespace palpate
