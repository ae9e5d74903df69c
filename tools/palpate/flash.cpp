// SPDX-License-Identifier: GPL-3.0-or-later
// palpate flash: an image into a device, over USB DFU.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "hal/flash/update.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/device_choice.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/signing.hpp"

namespace palpate::cli {
namespace {

using hal::flash::UpdateTarget;
using hal::usb::Kind;

constexpr std::chrono::milliseconds kLookEvery(200);
constexpr std::chrono::seconds kBackWithin(15);

struct FlashOptions {
  std::filesystem::path image;
  std::string device;
  std::string slot;
  SignOptions sign;
  bool verify = false;
  bool quiet = false;
};

std::string name_of(std::uint8_t slot) { return slot == 0 ? "A" : "B"; }

bool is_same(const UpdateTarget& target, const ImageFile& image) {
  const auto& held = target.image.content_sha256;
  return target.image.active_slot != hal::protocol::kNoSlot &&
         std::equal(held.begin(), held.end(), std::begin(image.view().header->content_sha256));
}

UpdateTarget target_of(const std::string& device) {
  UpdateTarget target;
  const auto exchange = open_usb(device, Kind::open_protocol);
  if (const auto problem = hal::flash::read_target(*exchange, target)) fail(device, *problem);
  return target;
}

/// The device restarts. It leaves the bus for that: nothing of it stays open here.
void restart(const std::string& device) {
  const auto exchange = open_usb(device, Kind::open_protocol);
  if (const auto problem = hal::flash::restart(*exchange)) fail(device, *problem);
}

/// After its restart the device has to use the image. At first it may still be there as before.
void await(const std::string& device, const ImageFile& image) {
  const auto give_up = std::chrono::steady_clock::now() + kBackWithin;
  std::string last = "it is not on the bus";
  while (std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(kLookEvery);
    auto opened = hal::usb::open_transport(Kind::open_protocol, parse_device(device).serial);
    const auto* exchange = std::get_if<std::unique_ptr<hal::Transport>>(&opened);
    UpdateTarget target;
    const auto problem = exchange == nullptr ? std::get<hal::DeviceProblem>(opened)
                                             : hal::flash::read_target(**exchange, target);
    if (!problem && is_same(target, image)) return;
    last = problem ? problem->cause : "it uses another image";
  }
  throw Failure(kDevice, "the device did not come back with the new image, " + last, device,
                "switch it off and on, then see 'palpate devices'");
}

void flash(const FlashOptions& options) {
  const ImageFile image(options.image);
  if (parse_device(options.device).kind != "usb") {
    throw Failure(kDevice, "this kind of device holds no images", options.device,
                  "name one of the open protocol: usb or usb:SERIAL");
  }
  const std::vector<std::byte> file = with_signature(image.bytes(), options.sign);
  std::optional<std::uint8_t> wanted;
  if (!options.slot.empty()) wanted = static_cast<std::uint8_t>(options.slot == "A" ? 0 : 1);
  const UpdateTarget target = target_of(options.device);
  if (!wanted && is_same(target, image)) {
    std::cout << "The device already uses this image, from slot "
              << name_of(target.image.active_slot) << ".\n";
    return;
  }
  const auto chosen = hal::flash::choose_slot(target, file.size(), wanted);
  if (const auto* problem = std::get_if<hal::DeviceProblem>(&chosen))
    fail(options.device, *problem);
  const auto slot = std::get<std::uint8_t>(chosen);
  {
    const auto update = open_usb(options.device, Kind::update);
    const bake::Progress show = progress(options.quiet);
    hal::MonotonicClock clock;
    if (const auto problem = hal::flash::write_slot(*update, clock, slot, file, show)) {
      fail(options.device, *problem);
    }
  }
  restart(options.device);
  if (options.verify) await(options.device, image);
  std::cout << "Slot " << name_of(slot) << " holds the image, read back and compared; the device "
            << (options.verify ? "uses it.\n" : "starts with it.\n");
}

}  // namespace

void add_flash(CLI::App& app) {
  auto options = std::make_shared<FlashOptions>();
  CLI::App* command = app.add_subcommand(
      "flash", "Write an image to a device, read it back, and only then switch to it");
  command->add_option("IMAGE", options->image, "Image made by bake")->required();
  command->add_option("--device", options->device, "usb[:SERIAL]")->required()->check(is_device());
  command->add_option("--slot", options->slot, "A or B; absent: the one that is not in use")
      ->check(CLI::IsMember({"A", "B"}));
  add_sign_options(*command, options->sign);
  command->add_flag("--verify", options->verify,
                    "also wait for the device's restart and see that it uses the image");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->callback([options] { flash(*options); });
}

}  // namespace palpate::cli
