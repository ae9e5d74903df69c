// SPDX-License-Identifier: GPL-3.0-or-later
// Whole programs with a simulated device on USB: this project's and dfu-util, an implementation of
// others. umockdev pretends that there is a device, a preloaded usbfs answers for it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate {
namespace {

using nlohmann::json;

/// Device and configuration descriptor, as hal/simulator/descriptors.cpp has them, in hexadecimal.
constexpr const char* kDescriptors =
    "12010002000000400912010000010001020109023E00020100803209040000"
    "02FF504100"
    "0705810340000207050103400002"
    "0904010000FE0102000904010100FE010200092107000000041001";

/// Devices 2, 3, ... of bus 1.
std::string description(int devices) {
  const std::string descriptors = kDescriptors;
  std::string text;
  for (int i = 0; i < devices; ++i) {
    const std::string port = std::to_string(i + 1), number = std::to_string(i + 2);
    text += "P: /devices/usb1/1-" + port + "\nN: bus/usb/001/00" + number + "=" + descriptors +
            "\nE: DEVNAME=/dev/bus/usb/001/00" + number +
            "\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM=00" + number +
            "\nE: SUBSYSTEM=usb\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" + number +
            "\\n\nA: bNumConfigurations=1\\n\nA: idVendor=1209\\n\nA: idProduct=0001\\n\n"
            "A: speed=480\\n\nH: descriptors=" +
            descriptors + "\n\n";
  }
  return text;
}

class UsbProcess : public testing::Test {
 protected:
  UsbProcess() {
    plug_in({path("flash")});
    put_image("one.palp", 1.0);
    put_image("two.palp", 2.0);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() / name; }
  void put_image(const std::string& name, double radius_m) const {
    const auto bytes = test::seal(test::parts_of({test::ball_part(0.5f, 5, 8)}, radius_m));
    folder_.write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  /// From now on these are connected; the words of tests/support/usbfs_shim.cpp.
  void plug_in(const std::vector<std::string>& devices) {
    folder_.write("device.umockdev", description(static_cast<int>(devices.size())));
    devices_.clear();
    for (const std::string& device : devices) devices_ += (devices_.empty() ? "" : ":") + device;
  }
  /// A program with the devices plugged in; what is in a device's flash stays from one to the next.
  [[nodiscard]] test::Outcome with_device(std::vector<std::string> command) const {
    command.insert(command.begin(),
                   {UMOCKDEV_RUN, "-d", path("device.umockdev"), "--", "/usr/bin/env",
                    "PALPATE_SHIM_DEVICES=" + devices_,
                    key_file_.empty() ? "PALPATE_NO_KEY=" : "PALPATE_SHIM_KEY=" + key_file_,
                    "LD_PRELOAD=" PALPATE_SHIM " libumockdev-preload.so.0"});
    return test::run(std::move(command));
  }
  [[nodiscard]] test::Outcome palpate(std::vector<std::string> arguments) const {
    arguments.emplace(arguments.begin(), PALPATE_EXECUTABLE);
    return with_device(std::move(arguments));
  }
  [[nodiscard]] test::Outcome dfu_util(std::vector<std::string> arguments) const {
    arguments.emplace(arguments.begin(), DFU_UTIL);
    return with_device(std::move(arguments));
  }
  /// A DFU file of an image for a product.
  void emit(const std::string& image, const std::string& out, const std::string& product) const {
    ASSERT_EQ(test::run({PALPATE_EXECUTABLE, "emit", path(image), "--as", "dfu", "--vendor-id",
                         "0x1209", "--product-id", product, "-o", path(out)})
                  .status,
              0);
  }
  test::TemporaryFolder folder_;
  std::string devices_;
  std::string key_file_;
};

TEST_F(UsbProcess, device_is_listed_as_ready) {
  const test::Outcome outcome = palpate({"devices", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json list = json::parse(outcome.out);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["kind"], "usb");
  EXPECT_EQ(list[0]["path"], "1-1");
  EXPECT_EQ(list[0]["serial"], "SIM1");
  EXPECT_EQ(list[0]["state"], "ready");
}

TEST_F(UsbProcess, each_of_several_devices_says_what_is_wrong_with_it_and_the_fix) {
  plug_in({path("flash"), "denied", "busy", "version"});
  const json list = json::parse(palpate({"devices", "--json"}).out);
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0]["state"], "ready");
  const auto problem = [&](std::size_t i) { return list[i]["problem"].get<std::string>(); };
  EXPECT_EQ(problem(1), "open: no permission to use the device");
  EXPECT_NE(list[1]["mend"].get<std::string>().find("tools/setup/host"), std::string::npos);
  EXPECT_EQ(problem(2), "claim: another program uses the device");
  EXPECT_EQ(problem(3),
            "descriptors: the device speaks version 2 of the protocol, this host version 1");
  for (std::size_t i = 1; i < 4; ++i) EXPECT_FALSE(list[i]["mend"].get<std::string>().empty());
}

TEST_F(UsbProcess, one_of_several_devices_is_chosen_by_its_serial_number) {
  plug_in({path("flash"), path("flash_2")});
  const test::Outcome unnamed = palpate({"flash", path("one.palp"), "--device", "usb"});
  EXPECT_EQ(unnamed.status, 4);
  EXPECT_NE(unnamed.err.find("more than one such device"), std::string::npos) << unnamed.err;
  EXPECT_NE(unnamed.err.find("SIM1, SIM2"), std::string::npos) << unnamed.err;
  ASSERT_EQ(palpate({"flash", path("one.palp"), "--device", "usb:SIM2"}).status, 0);
  const auto holds = [&](const char* device) {
    return palpate({"flash", path("one.palp"), "--device", device}).out.find("already uses") !=
           std::string::npos;
  };
  EXPECT_TRUE(holds("usb:SIM2"));
  EXPECT_FALSE(holds("usb:SIM1"));
  const test::Outcome unknown = palpate({"flash", path("one.palp"), "--device", "usb:SIM3"});
  EXPECT_EQ(unknown.status, 4);
  EXPECT_NE(unknown.err.find("SIM1, SIM2"), std::string::npos) << unknown.err;
}

TEST_F(UsbProcess, device_that_arrives_late_is_found_by_the_next_command) {
  plug_in({});
  const test::Outcome early = palpate({"flash", path("one.palp"), "--device", "usb"});
  EXPECT_EQ(early.status, 4);
  EXPECT_NE(early.err.find("device failed at find, no such device is connected"), std::string::npos)
      << early.err;
  plug_in({path("flash")});
  EXPECT_EQ(palpate({"flash", path("one.palp"), "--device", "usb"}).status, 0);
}

TEST_F(UsbProcess, flash_writes_the_slots_in_turn_and_switches) {
  const test::Outcome first = palpate({"flash", path("one.palp"), "--device", "usb", "--verify"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out, "Slot A holds the image, read back and compared; the device uses it.\n");
  const test::Outcome second = palpate({"flash", path("two.palp"), "--device", "usb", "--verify"});
  EXPECT_EQ(second.out, "Slot B holds the image, read back and compared; the device uses it.\n");
  const test::Outcome again = palpate({"flash", path("two.palp"), "--device", "usb"});
  EXPECT_EQ(again.out, "The device already uses this image, from slot B.\n");
  const test::Outcome in_use =
      palpate({"flash", path("one.palp"), "--device", "usb", "--slot", "B"});
  EXPECT_EQ(in_use.status, 4);
  EXPECT_NE(in_use.err.find("slot B is in use"), std::string::npos) << in_use.err;
}

TEST_F(UsbProcess, flash_verifies_a_device_that_restarts_without_leaving_the_bus) {
  plug_in({"stays=" + path("flash")});
  const test::Outcome outcome = palpate({"flash", path("one.palp"), "--device", "usb", "--verify"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "Slot A holds the image, read back and compared; the device uses it.\n");
}

TEST_F(UsbProcess, dfu_util_writes_and_reads_back_the_same_bytes) {
  emit("one.palp", "one.dfu", "0x0001");
  const test::Outcome written = dfu_util({"-a", "0", "-D", path("one.dfu")});
  ASSERT_EQ(written.status, 0) << written.out << written.err;
  const test::Outcome read = dfu_util({"-a", "0", "-U", path("back")});
  ASSERT_EQ(read.status, 0) << read.err;
  EXPECT_EQ(test::read_file(path("back")), test::read_file(path("one.palp")));
  // And it is the one in use from the next start on.
  const test::Outcome flashed = palpate({"flash", path("one.palp"), "--device", "usb"});
  EXPECT_EQ(flashed.out, "The device already uses this image, from slot A.\n") << flashed.err;
}

TEST_F(UsbProcess, dfu_util_cannot_write_the_slot_in_use_or_what_is_no_image) {
  ASSERT_EQ(palpate({"flash", path("one.palp"), "--device", "usb"}).status, 0);
  emit("two.palp", "two.dfu", "0x0001");
  EXPECT_NE(dfu_util({"-a", "0", "-D", path("two.dfu")}).status, 0);
  std::string bad = test::read_file(path("two.palp"));
  bad[700] = static_cast<char>(bad[700] ^ 1);
  folder_.write("bad.raw", bad);
  // It reports what the device says about the manifestation, whatever its exit status.
  const test::Outcome refused = dfu_util({"-a", "1", "-D", path("bad.raw")});
  EXPECT_NE(refused.out.find("dfuERROR"), std::string::npos) << refused.out;
  const test::Outcome kept = palpate({"flash", path("one.palp"), "--device", "usb"});
  EXPECT_EQ(kept.out, "The device already uses this image, from slot A.\n") << kept.err;
}

TEST_F(UsbProcess, dfu_util_refuses_a_file_for_another_product) {
  emit("one.palp", "other.dfu", "0x0002");
  const test::Outcome outcome = dfu_util({"-d", "1209:0001", "-a", "0", "-D", path("other.dfu")});
  EXPECT_EQ(outcome.status, 64) << outcome.err;
  EXPECT_NE(palpate({"flash", path("one.palp"), "--device", "usb"}).out.find("Slot A"),
            std::string::npos);
}

#ifdef PALPATE_SODIUM
TEST_F(UsbProcess, device_with_a_key_takes_signed_images_that_are_not_older) {
  const test::Outcome made =
      test::run({PALPATE_EXECUTABLE, "key", path("secret.pem"), "--new", "--c", path("key.h")});
  ASSERT_EQ(made.status, 0) << made.err;
  // What firmware gets: "0x12, 0x34, ...".
  std::istringstream source(test::read_file(path("key.h")));
  std::string key;
  for (std::string word; source >> word;) {
    if (word.rfind("0x", 0) == 0) key += static_cast<char>(std::stoi(word, nullptr, 16));
  }
  ASSERT_EQ(key.size(), 32u);
  folder_.write("key", key);
  key_file_ = path("key");

  const auto flash = [&](const char* image, std::vector<std::string> more) {
    std::vector<std::string> arguments{"flash", path(image), "--device", "usb", "--verify"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return palpate(arguments);
  };
  const test::Outcome unsigned_one = flash("one.palp", {});
  EXPECT_EQ(unsigned_one.status, 4);
  EXPECT_NE(unsigned_one.err.find("not signed with the device's key"), std::string::npos)
      << unsigned_one.err;
  const test::Outcome first = flash("one.palp", {"--sign", path("secret.pem"), "--counter", "5"});
  EXPECT_EQ(first.status, 0) << first.err;
  const test::Outcome older = flash("two.palp", {"--sign", path("secret.pem"), "--counter", "4"});
  EXPECT_EQ(older.status, 4);
  EXPECT_NE(older.err.find("older than what the device has confirmed"), std::string::npos)
      << older.err;

  // And by the other program, from a signed DFU file.
  ASSERT_EQ(test::run({PALPATE_EXECUTABLE, "emit", path("two.palp"), "--as", "dfu", "--sign",
                       path("secret.pem"), "--counter", "6", "-o", path("two.dfu")})
                .status,
            0);
  ASSERT_EQ(dfu_util({"-a", "1", "-D", path("two.dfu")}).status, 0);
  const test::Outcome used = flash("two.palp", {"--sign", path("secret.pem"), "--counter", "6"});
  EXPECT_EQ(used.out, "The device already uses this image, from slot B.\n") << used.err;
}
#endif

// How late a tick is depends on the machine, so 0 and 5 are both right; at 50 Hz it may stand still
// for 40 ms before the device gives the loop up.
TEST_F(UsbProcess, run_refuses_a_device_with_an_image_of_another_scene) {
  folder_.write("cube.palp", test::cube_image());
  folder_.write("scene.toml", test::cube_loop_scene());
  ASSERT_EQ(palpate({"flash", path("one.palp"), "--device", "usb"}).status, 0);
  const auto run = [&] {
    return palpate({"run", path("scene.toml"), "--device", "usb", "--seconds", "0.1", "--rate",
                    "50", "--quiet"});
  };
  const test::Outcome refused = run();
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.err.find("device failed at image identity"), std::string::npos) << refused.err;
  ASSERT_EQ(palpate({"flash", path("cube.palp"), "--device", "usb"}).status, 0);
  EXPECT_NE(run().status, 4);
}

TEST_F(UsbProcess, run_feels_the_contact_through_the_device) {
  folder_.write("cube.palp", test::cube_image());
  folder_.write("scene.toml", test::cube_loop_scene());
  // A host that stalls for longer than a command's life ends the force, as it has to, and with it
  // the run: that run says nothing of contacts.
  constexpr int kRuns = 4;
  json j = json::object();
  for (int i = 0; i < kRuns && j.value("state", "") != "rendering"; ++i) {
    const test::Outcome outcome = palpate({"run", path("scene.toml"), "--device", "usb",
                                           "--seconds", "4", "--rate", "50", "--json", "--quiet"});
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 4 || outcome.status == 5)
        << outcome.out << outcome.err;
    EXPECT_EQ(outcome.err.find("shim: "), std::string::npos) << outcome.err;
    j = json::parse(outcome.out);
  }
  EXPECT_EQ(j["state"], "rendering") << j["faults"];
  EXPECT_GT(j["touching"].get<int>(), 0);
  EXPECT_GT(j["force_N"]["max"].get<double>(), 0.01);
  EXPECT_EQ(j["allocations"].is_null() ? 0 : j["allocations"].get<int>(), 0);
}

// A host that stalls is silenced before anything happens to the device: once more.
TEST_F(UsbProcess, run_says_what_the_device_said_in_which_tick_and_how_to_fix_it) {
  folder_.write("cube.palp", test::cube_image());
  folder_.write("scene.toml", test::cube_loop_scene());
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"unplugged", "unplugged"}, {"motor", "motor_failure"}, {"refuses", "refused"}};
  for (const auto& [what, said] : cases) {
    plug_in({what + "=" + path("flash")});
    constexpr int kRuns = 4;
    json first = json::object();
    test::Outcome outcome;
    for (int i = 0; i < kRuns && first.value("device", "") != said; ++i) {
      outcome = palpate({"run", path("scene.toml"), "--device", "usb", "--seconds", "3.5", "--rate",
                         "50", "--json", "--quiet"});
      ASSERT_TRUE(outcome.status == 4 || outcome.status == 5) << outcome.out << outcome.err;
      const json j = json::parse(outcome.out);
      EXPECT_EQ(j["state"], "fault");
      ASSERT_FALSE(j["fault_details"].empty());
      first = j["fault_details"][0];
    }
    EXPECT_EQ(first["device"], said);
    EXPECT_EQ(first["fault"], "device_error");
    EXPECT_GT(first["tick"].get<int>(), 100);
    EXPECT_FALSE(first["fix"].get<std::string>().empty());
    if (outcome.status != 4) continue;
    EXPECT_EQ(outcome.err.rfind("palpate: error: the device ", 0), 0u) << outcome.err;
  }
}

}  // namespace
}  // namespace palpate
