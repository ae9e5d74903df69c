// SPDX-License-Identifier: Apache-2.0
// Simulated devices of the open protocol for any program that uses libusb: to be preloaded. Opening
// /dev/bus/usb/001/002 reaches the first one, 003 the second; that there are such devices must come
// from elsewhere (umockdev). PALPATE_SHIM_DEVICES has a word for each, with colons between: the
// file of its flash, or "denied" (nobody may open it), "busy" (another program has it), "version"
// (it speaks another version of the protocol). Before a file may stand "stays=" (it restarts
// without leaving the bus), or what happens once it has rendered a force for a while: "unplugged=",
// "motor=" or "refuses=". PALPATE_SHIM_KEY may name a file with the 32 bytes of the public key that
// images must be signed for.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/types.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulated_usbfs.hpp"
#include "hal/flash/file_flash.hpp"
#include "hal/simulator/open_device.hpp"

namespace palpate::hal::test {
namespace {

constexpr std::string_view kNodes = "/dev/bus/usb/001/00";
constexpr int kFirstNode = 2;
/// Periods with a force before something happens to a device.
constexpr std::uint64_t kUntilTrouble = 100;

/// Says that it speaks another version of the protocol.
class Foreigner final : public simulator::OpenDevice {
 public:
  using OpenDevice::OpenDevice;
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override {
    const IoResult result = OpenDevice::control_in(request, out);
    if (request.type == protocol::kVendorIn && result.bytes > 2) out[2] = std::byte{2};
    return result;
  }
};

/// Something happens to it while it renders.
class Troubled final : public simulator::OpenDevice {
 public:
  Troubled(simulator::OpenDeviceOptions options, std::string trouble)
      : OpenDevice(std::move(options)), trouble_(std::move(trouble)) {}
  void advance_to(std::uint64_t now_ns) override {
    OpenDevice::advance_to(now_ns);
    if (happened_ || periods_with_force() < kUntilTrouble) return;
    happened_ = true;
    if (trouble_ == "motor") set_health(protocol::kMotorFailure);
    if (trouble_ == "refuses") bus_reset();  // its session is over
    gone_ = trouble_ == "unplugged";
  }
  [[nodiscard]] simulator::Presence presence() const override {
    return gone_ ? simulator::Presence{false, 1} : OpenDevice::presence();
  }

 private:
  std::string trouble_;
  bool happened_ = false;
  bool gone_ = false;
};

/// "WHAT=FILE", or "FILE".
struct Word {
  explicit Word(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) what = text.substr(0, equals);
    file = equals == std::string::npos ? text : text.substr(equals + 1);
  }
  std::string what, file;
};

/// The 32 bytes of the file named by PALPATE_SHIM_KEY; absent where none is named.
std::optional<signature::PublicKey> key() {
  const char* file = std::getenv("PALPATE_SHIM_KEY");
  if (file == nullptr) return std::nullopt;
  signature::PublicKey key{};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(key.data()), key.size());
  return key;
}

struct Shim {
  Shim(const Word& word, const std::string& serial)
      : flash(word.file, layout), model(options(word, serial), word.what), usbfs(model) {}

  simulator::OpenDeviceOptions options(const Word& word, const std::string& serial) {
    simulator::OpenDeviceOptions out;
    if (word.what == "stays") out.restart_ns = 0;
    out.flash = &flash;
    out.layout = layout;
    out.key = key();
    out.serial = serial;
    // The hand presses 5 mm towards the scene's centre along x and back, each second.
    out.hand.rest.position_m = {0.0102, 0, 0};
    out.hand.script = {
        {0, {{0.0102, 0, 0}, {}}}, {0.5, {{0.0092, 0, 0}, {}}}, {1, {{0.0102, 0, 0}, {}}}};
    out.capabilities.max_life_us = protocol::kMaxCommandLife_us;
    out.capabilities.max_state_age_us = 1'000'000;
    return out;
  }

  flash::SlotLayout layout{4096, 64};
  flash::FileFlash flash;
  Troubled model;
  EmulatedUsbfs usbfs;
};

/// One that cannot be used.
struct Unusable {
  explicit Unusable(const std::string& serial, int claim_result) : model(options(serial)) {
    usbfs.refuse_claims(claim_result);
  }
  static simulator::OpenDeviceOptions options(const std::string& serial) {
    simulator::OpenDeviceOptions out;
    out.serial = serial;
    return out;
  }
  Foreigner model;
  EmulatedUsbfs usbfs{model};
};

struct Bus {
  std::deque<Shim> usable;
  std::deque<Unusable> unusable;
  std::vector<EmulatedUsbfs*> ports;  ///< null: nobody may open it
};

Bus make_bus() {
  Bus bus;
  const char* words = std::getenv("PALPATE_SHIM_DEVICES");
  std::istringstream list(words == nullptr ? "" : words);
  for (std::string word; std::getline(list, word, ':');) {
    const std::string serial = "SIM" + std::to_string(bus.ports.size() + 1);
    if (word == "denied") {
      bus.ports.push_back(nullptr);
    } else if (word == "busy" || word == "version") {
      bus.ports.push_back(&bus.unusable.emplace_back(serial, word == "busy" ? -EBUSY : 0).usbfs);
    } else {
      bus.ports.push_back(&bus.usable.emplace_back(Word(word), serial).usbfs);
    }
  }
  return bus;
}

/// The devices are made when one is opened first, and live as long as the process.
Bus& bus() {
  static Bus the_bus = make_bus();
  return the_bus;
}

/// A device still renders a force.
bool any_renders() {
  for (Shim& shim : bus().usable) {
    if (shim.usbfs.look([&] { return norm(shim.model.rendered().force_N) > 0; })) return true;
  }
  return false;
}

/// The descriptor of a node of ours, or a negative errno; absent where it is not ours.
std::optional<int> open_node(std::string_view path) {
  if (path.substr(0, kNodes.size()) != kNodes) return std::nullopt;
  const int index = std::atoi(path.substr(kNodes.size()).data()) - kFirstNode;
  if (index < 0 || index >= static_cast<int>(bus().ports.size())) return -ENODEV;
  EmulatedUsbfs* port = bus().ports[static_cast<std::size_t>(index)];
  return port == nullptr ? -EACCES : port->open();
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int open_file(const char* name, const char* path, int flags, va_list arguments) {
  if (const auto result = open_node(path)) return static_cast<int>(with_errno(*result));
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
  return next<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace
}  // namespace palpate::hal::test

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = palpate::hal::test::open_file("open", path, flags, arguments);
  va_end(arguments);
  return fd;
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = palpate::hal::test::open_file("open64", path, flags, arguments);
  va_end(arguments);
  return fd;
}

int __open_2(const char* path, int flags);
int __open64_2(const char* path, int flags);
int __open_2(const char* path, int flags) { return open(path, flags); }
int __open64_2(const char* path, int flags) { return open64(path, flags); }

/// Unlocking memory takes long where there is much of it: no force may wait for that.
int munlockall() noexcept {
  if (palpate::hal::test::any_renders()) {
    std::fputs("shim: memory is unlocked while a device renders a force\n", stderr);
  }
  return palpate::hal::test::next<int()>("munlockall")();
}

int close(int fd) {
  if (auto* usbfs = palpate::hal::test::usbfs_of(fd)) {
    usbfs->close(fd);
    return 0;
  }
  return palpate::hal::test::next<int(int)>("close")(fd);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (auto* usbfs = palpate::hal::test::usbfs_of(fd)) {
    return static_cast<int>(palpate::hal::test::with_errno(usbfs->on_ioctl(fd, request, argument)));
  }
  return palpate::hal::test::next<int(int, unsigned long, void*)>("ioctl")(fd, request, argument);
}
}
