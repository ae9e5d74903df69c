// SPDX-License-Identifier: Apache-2.0
// A client of USB/IP whose server is this test: right, and hostile.
#include "hal/usbip/client.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>
#include <span>
#include <variant>
#include <vector>

namespace palpate::hal::usbip {
namespace {

class UsbipClient : public ::testing::Test {
 protected:
  UsbipClient() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    server_ = ends[0];
    client_ = std::make_unique<ClientTransport>(ends[1]);
  }
  ~UsbipClient() override { ::close(server_); }

  void say(std::span<const std::byte> bytes) const {
    EXPECT_EQ(::send(server_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// The end of a transfer. @param sequence  they are numbered from 1
  void say_end(std::uint32_t sequence, std::uint32_t length, std::size_t data_bytes,
               std::int32_t status = kDone, Command command = Command::submit_reply) const {
    TransferHeader header;
    header.command = command;
    header.sequence = sequence;
    header.length = length;
    header.status = status;
    say(encode(header));
    say(std::vector<std::byte>(data_bytes, std::byte{7}));
  }
  IoResult ask(std::size_t room = 8) {
    data_.assign(room, std::byte{0});
    return client_->control_in({0x80, 6, 0x0100, 0}, data_, 100);
  }

  int server_ = -1;
  std::unique_ptr<ClientTransport> client_;
  std::vector<std::byte> data_;
};

TEST_F(UsbipClient, answer_is_had_and_less_than_was_asked_for_too) {
  say_end(1, 5, 5);
  const IoResult result = ask();
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.bytes, 5u);
  EXPECT_EQ(data_[4], std::byte{7});
  EXPECT_EQ(data_[5], std::byte{0});
  say_end(2, 0, 0, kStalled);
  EXPECT_EQ(ask().status, IoStatus::stalled);
  say_end(3, 0, 0, kOverflow);
  EXPECT_EQ(ask().status, IoStatus::failed);
}

TEST_F(UsbipClient, late_answer_is_of_its_own_request) {
  EXPECT_EQ(ask().status, IoStatus::timed_out);  // 1, and 2 gives it up
  say_end(1, 8, 8);                              // too late to be given up
  say_end(2, 0, 0, kDone, Command::unlink_reply);
  say_end(3, 3, 3);
  EXPECT_EQ(ask().bytes, 3u);
}

TEST_F(UsbipClient, more_than_was_asked_for_loses_the_device) {
  say_end(1, 9, 9);
  EXPECT_EQ(ask().status, IoStatus::lost);
  EXPECT_EQ(ask().status, IoStatus::lost);
  EXPECT_FALSE(client_->submit({}));
}

TEST_F(UsbipClient, answer_to_nothing_loses_the_device) {
  say_end(77, 0, 0);
  EXPECT_EQ(ask().status, IoStatus::lost);
}

TEST_F(UsbipClient, answer_of_another_kind_loses_the_device) {
  say_end(1, 0, 0, kDone, Command::unlink_reply);
  EXPECT_EQ(ask().status, IoStatus::lost);
}

TEST_F(UsbipClient, server_that_stops_in_the_middle_is_not_waited_for) {
  say(std::vector<std::byte>(10));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(ask().status, IoStatus::lost);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(UsbipClient, server_that_leaves_loses_the_device) {
  ::shutdown(server_, SHUT_RDWR);
  EXPECT_EQ(ask().status, IoStatus::lost);
}

TEST_F(UsbipClient, stream_delivers_and_ends_though_nobody_answers) {
  struct Sink final : StreamSink {
    std::size_t bytes = 0;
    void received(std::span<const std::byte> got, std::uint64_t /*now_ns*/) noexcept override {
      bytes += got.size();
    }
  } sink;
  ASSERT_EQ(client_->begin_stream(), IoStatus::ok);
  say_end(2, 64, 64);
  MonotonicClock clock;
  EXPECT_EQ(client_->wait(clock.now_ns() + 1'000'000'000, sink), IoStatus::ok);
  EXPECT_EQ(sink.bytes, 64u);
  const std::vector<std::byte> data(64);
  for (std::size_t i = 0; i < ClientTransport::kOutTransfers; ++i) {
    EXPECT_TRUE(client_->submit(data));
  }
  EXPECT_FALSE(client_->submit(data));
  client_->end_stream();  // a second
  EXPECT_EQ(client_->pending(), 0u);
}

TEST(UsbipClientNoise, breaks_nothing) {
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same in every run
  std::uniform_int_distribution<int> byte(0, 255);
  for (int round = 0; round < 200; ++round) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    ClientTransport client(ends[1]);
    // As far as a right answer goes, then noise.
    TransferHeader header;
    header.command = Command::submit_reply;
    header.sequence = 1;
    auto right = encode(header);
    for (std::size_t i = static_cast<std::size_t>(round) % right.size(); i < right.size(); ++i) {
      right[i] = static_cast<std::byte>(byte(random));
    }
    ::send(ends[0], right.data(), right.size(), MSG_NOSIGNAL);
    ::close(ends[0]);
    std::array<std::byte, 32> out{};
    static_cast<void>(client.control_in({0x80, 6, 0x0100, 0}, out, 10));
    EXPECT_EQ(client.control_in({0x80, 6, 0x0100, 0}, out, 10).status, IoStatus::lost);
  }
}

TEST(OpenDevice, nobody_there_is_said) {
  const auto opened = open_device("127.0.0.1", 1);
  ASSERT_TRUE(std::holds_alternative<DeviceProblem>(opened));
  EXPECT_NE(std::get<DeviceProblem>(opened).cause.find("127.0.0.1:1"), std::string::npos);
}

}  // namespace
}  // namespace palpate::hal::usbip
