// SPDX-License-Identifier: Apache-2.0
// The USB/IP server on a socket, with a client of our own and this project's whole host side on it.
#include "hal/usbip/server.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "../support/temporary_folder.hpp"
#include "../support/time.hpp"
#include "../support/tiny_image.hpp"
#include "../support/usbip_client.hpp"
#include "hal/flash/update.hpp"
#include "hal/protocol/host_driver.hpp"
#include "hal/simulator/flash_model.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/transport/streamed_device.hpp"
#include "hal/usbip/client.hpp"
#include "hal/usbip/vhci.hpp"

namespace palpate::hal::usbip {
namespace {

using simulator::OpenDevice;
using simulator::OpenDeviceOptions;
using test::kMs;

/// The longest life that the protocol knows: what a shared machine may stand still for.
OpenDeviceOptions patient() {
  OpenDeviceOptions options;
  options.capabilities.max_life_us = protocol::kMaxCommandLife_us;
  options.capabilities.max_state_age_us = 1'000'000;
  return options;
}

/// The server on a thread of its own.
class Running {
 public:
  explicit Running(OpenDeviceOptions options = patient())
      : device_(std::move(options)), server_(device_, clock_, "127.0.0.1", 0) {
    thread_ = std::thread([this] {
      while (!stop_) server_.step(clock_.now_ns() + 10 * kMs);
    });
  }
  ~Running() {
    stop_ = true;
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  Running(Running&&) = delete;
  Running& operator=(Running&&) = delete;

  [[nodiscard]] std::unique_ptr<ClientTransport> attach(std::uint8_t interface = 0) {
    auto transport = std::make_unique<ClientTransport>(test::connect_to(server_.port()),
                                                       ClientInterface{interface});
    // Whoever had the device before may just be leaving.
    for (int i = 0; i < 100; ++i) {
      if (transport->import()) return transport;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      transport = std::make_unique<ClientTransport>(test::connect_to(server_.port()),
                                                    ClientInterface{interface});
    }
    ADD_FAILURE() << "the server does not give the device";
    return transport;
  }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

 private:
  MonotonicClock clock_;
  OpenDevice device_;
  Server server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Answers the newest reading with a force along x. True where it was a new one.
bool push(StreamedDevice& device, MonotonicClock& clock, DeviceState& reading,
          DeviceCommand& command) {
  const bool is_new = device.receive(reading);
  ++command.sequence;
  command.time_ns = clock.now_ns();
  command.expires_ns = clock.now_ns() + 1000 * kMs;
  command.wrench.force_N = {2, 0, 0};
  command.answers = reading.sequence;
  command.state_time_ns = reading.time_ns;
  device.send(command);
  return is_new;
}

TEST(UsbipServer, exchange_runs_over_a_socket_and_again_after_leaving) {
  Running server;
  for (int visit = 0; visit < 2; ++visit) {
    MonotonicClock clock;
    StreamedDevice device(server.attach(), std::make_unique<protocol::HostDriver>(), clock, {});
    const auto opened = device.open();
    ASSERT_FALSE(opened) << opened->phase << ": " << opened->cause;
    ASSERT_FALSE(device.start());
    DeviceState reading;
    DeviceCommand command;
    std::uint64_t readings = 0;
    for (std::uint64_t next_ns = clock.now_ns(), i = 0; i < 300; ++i, next_ns += kMs) {
      clock.sleep_until(next_ns);
      if (push(device, clock, reading, command)) ++readings;
    }
    EXPECT_GT(readings, 30u);
    device.stop();
  }
}

TEST(UsbipServer, image_is_written_read_back_and_used) {
  const flash::SlotLayout layout{1024, 8};
  simulator::FlashModel memory(layout);
  OpenDeviceOptions options = patient();
  options.flash = &memory;
  options.layout = layout;
  Running server(options);
  const auto image =
      palpate::test::seal(palpate::test::parts_of({palpate::test::ball_part(0.5f, 5, 8)}));
  MonotonicClock clock;
  const auto problem =
      flash::write_slot(*server.attach(1), clock, 1, image, [](const char*, double) {});
  ASSERT_FALSE(problem) << problem->phase << ": " << problem->cause;
  auto exchange = server.attach();
  ASSERT_FALSE(flash::restart(*exchange));
  flash::UpdateTarget target;
  EXPECT_TRUE(flash::read_target(*exchange, target));  // it has left the bus
  exchange = server.attach();
  ASSERT_FALSE(flash::read_target(*exchange, target));
  EXPECT_EQ(target.image.active_slot, 1);
}

TEST(UsbipServer, owner_that_does_not_ask_has_the_device) {
  MonotonicClock clock;
  OpenDevice device(patient());
  Server server(device, clock, "127.0.0.1", 0);
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  server.adopt_owner(ends[0]);
  EXPECT_TRUE(server.attached());
  std::atomic<bool> stop{false};
  std::thread thread([&] {
    while (!stop) server.step(clock.now_ns() + kMs);
  });
  ClientTransport transport(ends[1]);
  protocol::Capabilities capabilities;
  EXPECT_FALSE(
      protocol::read_descriptor(transport, protocol::PacketType::capabilities, 0, capabilities));
  stop = true;
  thread.join();
}

TEST(Vhci, device_goes_to_the_first_free_port_of_its_speed) {
  const palpate::test::TemporaryFolder folder;
  folder.write("status",
               "hub port sta spd dev      sockfd local_busid\n"
               "hs  0000 006 003 00010002 000003 3-1\n"
               "hs  0001 004 000 00000000 000000 0-0\n"
               "ss  0008 004 000 00000000 000000 0-0\n");
  folder.write("attach", "");
  const Vhci vhci(folder.path());
  EXPECT_TRUE(vhci.has_device());
  ASSERT_TRUE(vhci.attach(7, simulator::UsbSpeed::high));
  EXPECT_EQ(palpate::test::read_file(folder.path() / "attach"), "1 7 65538 3");
}

TEST(Vhci, without_ports_or_the_right_to_them_nothing_is_attached) {
  const palpate::test::TemporaryFolder folder;
  EXPECT_FALSE(Vhci(folder.path()).attach(7, simulator::UsbSpeed::high));
  folder.write("status", "hs  0000 006 003 00020005 000003 3-1\n");
  EXPECT_FALSE(Vhci(folder.path()).has_device());
  EXPECT_FALSE(Vhci(folder.path()).attach(7, simulator::UsbSpeed::high));
  folder.write("status", "hs  0000 004 000 00000000 000000 0-0\n");
  EXPECT_FALSE(Vhci(folder.path()).attach(7, simulator::UsbSpeed::high));  // no such file
}

TEST(UsbipServer, too_many_clients_are_turned_away_and_rude_ones_closed) {
  Running server;
  std::vector<int> sockets;
  for (std::size_t i = 0; i < Server::kMaxClients; ++i) {
    sockets.push_back(test::connect_to(server.port()));
  }
  std::byte nothing{};
  const auto is_closed = [&](int fd) { return ::recv(fd, &nothing, 1, 0) == 0; };
  // Asked and answered: all those before have been accepted.
  const auto question = encode(Operation{});
  ASSERT_EQ(::send(sockets.back(), question.data(), question.size(), 0), 8);
  ASSERT_EQ(::recv(sockets.back(), &nothing, 1, 0), 1);
  const int ninth = test::connect_to(server.port());
  EXPECT_TRUE(is_closed(ninth));
  const std::vector<std::byte> garbage(100, std::byte{0x77});
  ASSERT_EQ(::send(sockets.front(), garbage.data(), garbage.size(), 0), 100);
  EXPECT_TRUE(is_closed(sockets.front()));
  ::close(ninth);
  for (const int fd : sockets) ::close(fd);
}

TEST(UsbipServer, address_that_is_taken_or_none_is_refused) {
  Running server;
  MonotonicClock clock;
  OpenDevice device{{}};
  EXPECT_THROW(Server(device, clock, "127.0.0.1", server.port()), std::system_error);
  EXPECT_THROW(Server(device, clock, "localhost", 0), std::system_error);
}

/// A host in a process of its own that pushes until it is killed. The device is this process's.
class KilledHost : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_), 0);
    server_.adopt(ends_[0]);
    child_ = ::fork();
    ASSERT_GE(child_, 0);
    if (child_ == 0) be_the_host();
  }
  [[noreturn]] void be_the_host() {
    auto transport = std::make_unique<ClientTransport>(ends_[1]);
    if (!transport->import()) ::_exit(1);
    MonotonicClock clock;
    StreamedDevice device(std::move(transport), std::make_unique<protocol::HostDriver>(), clock,
                          {});
    DeviceState reading;
    DeviceCommand command;
    if (device.open()) ::_exit(1);
    while (true) {
      // Where the machine stood still for too long the device has let go: once more.
      if (device.start()) ::_exit(1);
      while (device.faults() == kNoDeviceFault) {
        static_cast<void>(push(device, clock, reading, command));
        clock.sleep_until(clock.now_ns() + kMs);
      }
      device.stop();
    }
  }
  /// The device lives, and is served, until a condition holds; ten seconds at most.
  template <class Condition>
  bool live_until(Condition condition) {
    const std::uint64_t give_up_ns = clock_.now_ns() + 10'000 * kMs;
    while (!condition() && clock_.now_ns() < give_up_ns) server_.step(clock_.now_ns() + kMs);
    return condition();
  }
  /// Everything that the host has sent has arrived.
  void drain() {
    for (int i = 0; i < 100; ++i) server_.step(clock_.now_ns());
  }

  MonotonicClock clock_;
  OpenDevice device_{patient()};
  Server server_{device_, clock_, "127.0.0.1", 0};
  int ends_[2] = {-1, -1};
  pid_t child_ = -1;
};

// A kernel that outlives the program keeps the line open: the device must notice by itself. Where
// the line closes, as when the plug is pulled, it does at once.
TEST_P(KilledHost, leaves_no_force_after_the_commands_life_in_device_time) {
  const bool line_stays_open = GetParam();
  if (!line_stays_open) ::close(ends_[1]);
  ASSERT_TRUE(live_until([this] { return device_.periods_with_force() > 400; }));
  ASSERT_EQ(::kill(child_, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child_, nullptr, 0), child_);
  drain();
  const std::uint64_t before = device_.periods_with_force();
  const std::uint64_t periods = device_.periods();
  const std::uint64_t life_in_periods =
      std::uint64_t{protocol::kMaxCommandLife_us} * patient().capabilities.rate_Hz / 1'000'000;
  ASSERT_TRUE(live_until([&] { return device_.periods() > periods + 2 * life_in_periods; }));
  const std::uint64_t after = device_.periods_with_force() - before;
  EXPECT_LE(after, line_stays_open ? life_in_periods : 0);
  EXPECT_EQ(norm(device_.rendered().force_N), 0.0);
  RecordProperty("periods_with_force_after_the_kill", static_cast<int>(after));
  if (line_stays_open) ::close(ends_[1]);
}

INSTANTIATE_TEST_SUITE_P(Line, KilledHost, testing::Bool(), [](const auto& instance) {
  return instance.param ? "stays_open" : "closes";
});

}  // namespace
}  // namespace palpate::hal::usbip
