// SPDX-License-Identifier: GPL-3.0-or-later
// palpate-sim: a simulated haptic device on TCP, by USB/IP. A machine with Linux's vhci_hcd
// attaches it and has a USB device like any other.
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "config/scene.hpp"
#include "hal/flash/file_flash.hpp"
#include "hal/simulator/falcon_device.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/usbip/server.hpp"
#include "hal/usbip/vhci.hpp"
#include "tools/palpate/error_line.hpp"
#include "tools/palpate/key_file.hpp"
#include "tools/realtime/scene_hand.hpp"

namespace palpate::sim {
namespace {

namespace fs = std::filesystem;

/// Exit statuses as `palpate --help` has them.
enum Exit : int { kDone = 0, kOther = 1, kUsage = 2 };

constexpr std::uint32_t kBytesPerKiB = 1024;
/// How often a signal is looked for.
constexpr std::uint64_t kLookEvery_ns = 100'000'000;

struct Options {
  std::string kind = "usb";
  std::string address = "127.0.0.1";
  std::uint16_t port = hal::usbip::kTcpPort;
  std::string serial = "SIM0001";
  fs::path scene;
  fs::path flash;
  fs::path public_key;
  std::uint32_t slot_KiB = 512;
  std::uint32_t rate_Hz = 4000;
};

std::atomic<bool> g_stop{false};

int error(const std::string& message, Exit code) {
  cli::print_error("palpate-sim", message);
  return code;
}

/// The device and what it needs to live.
struct Simulated {
  std::unique_ptr<hal::flash::FileFlash> flash;
  std::unique_ptr<hal::simulator::SimulatedDevice> device;
};

Simulated make(const Options& options) {
  std::optional<config::Scene> scene;
  if (!options.scene.empty()) scene = config::load_scene(options.scene);
  Simulated out;
  if (options.kind == "falcon") {
    hal::simulator::FalconDeviceOptions falcon;
    falcon.serial = options.serial;
    if (scene) falcon.hand = realtime::hand_of(*scene);
    out.device = std::make_unique<hal::simulator::FalconDevice>(falcon);
    return out;
  }
  hal::simulator::OpenDeviceOptions open;
  open.serial = options.serial;
  open.capabilities.rate_Hz = options.rate_Hz;
  if (scene) open.hand = realtime::hand_of(*scene);
  if (!options.flash.empty()) {
    open.layout.image_units = options.slot_KiB * kBytesPerKiB / open.layout.erase_bytes;
    out.flash = std::make_unique<hal::flash::FileFlash>(options.flash, open.layout);
    open.flash = out.flash.get();
    if (!options.public_key.empty()) open.key = cli::read_public_pem(options.public_key);
  }
  out.device = std::make_unique<hal::simulator::OpenDevice>(std::move(open));
  return out;
}

/// Where this machine's kernel had the device, it gets it again after the device's restart: nobody
/// else would notice that it is back.
class Replugger {
 public:
  Replugger(hal::usbip::Server& server, const hal::simulator::SimulatedDevice& device)
      : server_(server), device_(device) {}

  /// Called now and then.
  void look() {
    const hal::simulator::Presence presence = device_.presence();
    if (server_.attached() && presence.times_left == times_left_) {
      plugged_in_here_ = vhci_.has_device();
    } else if (!server_.attached() && presence.on_bus) {
      // Not after somebody has detached it.
      if (plugged_in_here_ && presence.times_left != times_left_) plug_in();
      plugged_in_here_ = false;
      times_left_ = presence.times_left;
    }
  }

 private:
  void plug_in() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return;
    if (vhci_.attach(ends[1], device_.descriptors().speed)) {
      server_.adopt_owner(ends[0]);
    } else {
      ::close(ends[0]);
      std::printf("the device is back; attach it again\n");
      std::fflush(stdout);
    }
    ::close(ends[1]);
  }

  hal::usbip::Server& server_;
  const hal::simulator::SimulatedDevice& device_;
  hal::usbip::Vhci vhci_;
  bool plugged_in_here_ = false;
  std::uint32_t times_left_ = 0;  ///< by the device, when it was looked at last
};

int serve(const Options& options) {
  hal::MonotonicClock clock;
  const Simulated simulated = make(options);
  hal::usbip::Server server(*simulated.device, clock, options.address, options.port);
  std::printf(
      "A simulated device, %s:%s, on %s:%u. Where the kernel has vhci_hcd:\n"
      "  sudo modprobe vhci-hcd && sudo usbip --tcp-port %u attach -r %s -b %s\n",
      options.kind.c_str(), options.serial.c_str(), options.address.c_str(), server.port(),
      server.port(), options.address.c_str(), std::string(hal::usbip::kBusId).c_str());
  std::fflush(stdout);
  bool attached = false;
  Replugger replugger(server, *simulated.device);
  std::uint64_t look_ns = 0;
  while (!g_stop) {
    server.step(clock.now_ns() + kLookEvery_ns);
    if (clock.now_ns() >= look_ns) {
      replugger.look();
      look_ns = clock.now_ns() + kLookEvery_ns;
    }
    if (attached == server.attached()) continue;
    attached = server.attached();
    std::printf(attached ? "attached\n" : "detached\n");
    std::fflush(stdout);
  }
  return kDone;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("A simulated haptic device on TCP, by USB/IP");
  app.name("palpate-sim");
  app.set_version_flag("--version", "palpate-sim " PALPATE_VERSION);
  app.add_option("--device", options.kind, "what it is: usb (the open protocol) or falcon")
      ->check(CLI::IsMember({"usb", "falcon"}))
      ->capture_default_str();
  app.add_option("--address", options.address,
                 "IPv4 address to listen on; the protocol has no password")
      ->check(CLI::ValidIPV4)
      ->capture_default_str();
  app.add_option("--port", options.port, "TCP port; 0: any that is free")->capture_default_str();
  app.add_option("--serial", options.serial, "its serial number")->capture_default_str();
  app.add_option("--scene", options.scene, "its hand moves as the scene's [mock] says");
  app.add_option("--flash", options.flash,
                 "usb: it holds images, in this file, which is made where there is none");
  app.add_option("--public-key", options.public_key,
                 "usb: it takes only images signed for this key, a PEM file");
  app.add_option("--slot-kib", options.slot_KiB, "usb: size of a slot for images")
      ->check(CLI::Range(4u, 1u << 20))
      ->capture_default_str();
  app.add_option("--rate", options.rate_Hz, "usb: readings a second")
      ->check(CLI::Range(1u, 20000u))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return error(std::string(e.what()) + ": palpate-sim: see 'palpate-sim --help'", kUsage);
  }
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  return serve(options);
}

int run_and_report(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const config::ConfigError& e) {
    return error(e.what(), kUsage);
  } catch (const std::system_error& e) {
    return error("cannot be used: " + std::string(e.what()) + ": give another address or file",
                 kOther);
  } catch (...) {
    return error(cli::internal_error(), kOther);
  }
}

}  // namespace
}  // namespace palpate::sim

int main(int argc, char** argv) { return palpate::sim::run_and_report(argc, argv); }
