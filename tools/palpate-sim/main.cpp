// SPDX-License-Identifier: GPL-3.0-or-later
// palpate-sim: a simulated haptic device. On TCP, by USB/IP: a machine with Linux's vhci_hcd
// attaches it and has a USB device like any other. Or on the USB of a machine that has a device
// controller, by FunctionFS.
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
#include "hal/functionfs/function_fs.hpp"
#include "hal/simulator/falcon_device.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/usbip/server.hpp"
#include "tools/palpate-sim/device_log.hpp"
#include "tools/palpate-sim/replugger.hpp"
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
  fs::path functionfs;
  bool log = false;
  std::uint32_t slot_KiB = 512;
  std::uint32_t erase_ms = 0;
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
    open.flash_times.erase_ms = options.erase_ms;
    if (!options.public_key.empty()) open.key = cli::read_public_pem(options.public_key);
  }
  out.device = std::make_unique<hal::simulator::OpenDevice>(std::move(open));
  return out;
}

/// What happens to the device, on stdout.
class Watch {
 public:
  Watch(const Simulated& simulated, bool logged)
      : log_(logged ? dynamic_cast<const hal::simulator::OpenDevice*>(simulated.device.get())
                    : nullptr) {}
  void look(bool attached) {
    log_.look();
    if (attached == attached_) return;
    attached_ = attached;
    std::printf(attached ? "attached\n" : "detached\n");
    std::fflush(stdout);
  }

 private:
  DeviceLog log_;
  bool attached_ = false;
};

int serve_usbip(const Options& options, const Simulated& simulated) {
  hal::MonotonicClock clock;
  hal::usbip::Server server(*simulated.device, clock, options.address, options.port);
  std::printf(
      "A simulated device, %s:%s, on %s:%u. Where the kernel has vhci_hcd:\n"
      "  sudo modprobe vhci-hcd && sudo usbip --tcp-port %u attach -r %s -b %s\n",
      options.kind.c_str(), options.serial.c_str(), options.address.c_str(), server.port(),
      server.port(), options.address.c_str(), std::string(hal::usbip::kBusId).c_str());
  std::fflush(stdout);
  Replugger replugger(server, *simulated.device);
  Watch watch(simulated, options.log);
  std::uint64_t look_ns = 0;
  while (!g_stop) {
    server.step(clock.now_ns() + kLookEvery_ns);
    watch.look(server.attached());
    if (clock.now_ns() < look_ns) continue;
    replugger.look();
    look_ns = clock.now_ns() + kLookEvery_ns;
  }
  return kDone;
}

int serve_functionfs(const Options& options, const Simulated& simulated) {
  hal::MonotonicClock clock;
  hal::functionfs::FunctionFs front(*simulated.device, clock, options.functionfs);
  std::printf("A simulated device in %s: the gadget can be bound.\n", options.functionfs.c_str());
  std::fflush(stdout);
  Watch watch(simulated, options.log);
  front.run(g_stop, [&] { watch.look(front.attached()); });
  return kDone;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("A simulated haptic device on TCP, by USB/IP, or on this machine's own USB");
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
  app.add_option("--erase-ms", options.erase_ms,
                 "usb: what it takes to erase a unit of its flash, 4 KiB; 45 for a NOR flash")
      ->check(CLI::Range(0u, 10000u))
      ->capture_default_str();
  app.add_option("--rate", options.rate_Hz, "usb: readings a second")
      ->check(CLI::Range(1u, 20000u))
      ->capture_default_str();
  app.add_option(
      "--functionfs", options.functionfs,
      "usb: instead of TCP, the folder where FunctionFS is mounted; tools/gadget does the "
      "rest");
  app.add_flag("--log", options.log,
               "usb: a line with the time of day whenever the device's mode changes, or whether it "
               "renders a force");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return error(std::string(e.what()) + ": palpate-sim: see 'palpate-sim --help'", kUsage);
  }
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  const bool in_functionfs = !options.functionfs.empty();
  if (in_functionfs && (options.kind != "usb" || !options.flash.empty())) {
    return error(
        "--functionfs: not with a Falcon or --flash: FunctionFS gives one interface of the open "
        "protocol: leave them out",
        kUsage);
  }
  const Simulated simulated = make(options);
  return in_functionfs ? serve_functionfs(options, simulated) : serve_usbip(options, simulated);
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
