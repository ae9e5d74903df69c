// SPDX-License-Identifier: Apache-2.0
// USB/IP without a network: the messages and one client's connection, in virtual time.
#include "hal/usbip/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "../support/packets.hpp"
#include "../support/time.hpp"
#include "../support/usbip_client.hpp"
#include "hal/protocol/host_end.hpp"
#include "hal/simulator/open_device.hpp"

namespace palpate::hal::usbip {
namespace {

using simulator::OpenDevice;
using test::kMs;
using Bytes = std::vector<std::byte>;

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

template <class T>
Bytes bytes_of(const T& message, std::span<const std::byte> data = {}) {
  const auto encoded = encode(message);
  Bytes bytes(encoded.begin(), encoded.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

// The example of the kernel's documentation.
TEST(UsbipMessages, golden_bytes_of_the_documentation_are_met) {
  const Bytes in = from_hex(
      "0000000100000d050001000f0000000100000001000002000000004000ffffff0000000000000004"
      "0000000000000000");
  Bytes request = in;
  std::fill_n(request.begin() + 32, 4, std::byte{0xff});
  TransferHeader h;
  ASSERT_TRUE(decode(std::span(request).first<kTransferHeaderBytes>(), h));
  EXPECT_EQ(h.command, Command::submit);
  EXPECT_EQ(h.sequence, 0xd05u);
  EXPECT_EQ(h.device, 0x1000fu);
  EXPECT_TRUE(h.is_in);
  EXPECT_EQ(h.endpoint, 1u);
  EXPECT_EQ(h.length, 64u);

  TransferHeader reply;
  reply.command = Command::submit_reply;
  reply.sequence = 0xd06;
  reply.length = 64;
  EXPECT_EQ(bytes_of(reply), from_hex("0000000300000d0600000000000000000000000000000000"
                                      "00000040000000"
                                      "00ffffffff00000000"
                                      "0000000000000000"));
  EXPECT_EQ(bytes_of(Operation{}), from_hex("0111800500000000"));
}

TEST(UsbipMessages, headers_survive_the_round_trip_and_bad_ones_are_refused) {
  for (const Command command :
       {Command::submit, Command::unlink, Command::submit_reply, Command::unlink_reply}) {
    TransferHeader h;
    h.command = command;
    h.sequence = 0x01020304;
    h.device = 0x10002;
    h.is_in = true;
    h.endpoint = 15;
    TransferHeader again;
    const Bytes bytes = bytes_of(h);
    ASSERT_TRUE(decode(std::span(bytes).first<kTransferHeaderBytes>(), again));
    EXPECT_EQ(bytes_of(again), bytes);
  }
  const auto is_refused = [](std::size_t at, unsigned value) {
    Bytes bytes = bytes_of(TransferHeader{});
    bytes[at] = static_cast<std::byte>(value);
    TransferHeader out;
    return !decode(std::span(bytes).first<kTransferHeaderBytes>(), out);
  };
  EXPECT_TRUE(is_refused(3, 0));      // command
  EXPECT_TRUE(is_refused(3, 5));      // command
  EXPECT_TRUE(is_refused(15, 2));     // direction
  EXPECT_TRUE(is_refused(19, 16));    // endpoint
  EXPECT_TRUE(is_refused(24, 0x80));  // length
}

/// A device with one client or several, in virtual time.
struct Bus {
  Bus() { live(kMs); }
  /// The device lives on, and the clients are served.
  void live(std::uint64_t for_ns) {
    now_ns += for_ns;
    device.advance_to(now_ns);
  }
  static Bytes take(Session& session) { return std::exchange(session.output(), {}); }

  std::uint64_t now_ns = 0;
  OpenDevice device{{}};
  ExportedDevice exported{device};
};

/// With the device taken.
struct Attached : Bus {
  Attached() {
    EXPECT_TRUE(session.receive(test::import_request()));
    EXPECT_TRUE(session.attached());
    EXPECT_EQ(take(session).size(), kOperationBytes + kDeviceBytes);
  }
  /// Sends a request and gives what is answered at once.
  Bytes ask(const TransferHeader& h, std::span<const std::byte> data = {}) {
    EXPECT_TRUE(session.receive(bytes_of(h, data)));
    return take(session);
  }
  static TransferHeader header_of(const Bytes& answer) {
    TransferHeader h;
    EXPECT_GE(answer.size(), kTransferHeaderBytes);
    if (answer.size() >= kTransferHeaderBytes) {
      EXPECT_TRUE(decode(std::span(answer).first<kTransferHeaderBytes>(), h));
    }
    return h;
  }
  TransferHeader control(std::string setup_hex, bool is_in, std::uint32_t length) {
    TransferHeader h;
    h.sequence = ++sequence;
    h.is_in = is_in;
    h.length = length;
    const Bytes setup = from_hex(setup_hex);
    std::copy(setup.begin(), setup.end(), h.setup.begin());
    return h;
  }
  TransferHeader transfer(std::uint32_t endpoint, bool is_in, std::uint32_t length) {
    TransferHeader h;
    h.sequence = ++sequence;
    h.is_in = is_in;
    h.endpoint = endpoint;
    h.length = length;
    return h;
  }
  Session session{exported};
  std::uint32_t sequence = 0;
};

TEST(UsbipSession, device_is_listed_with_its_interfaces) {
  Bus bus;
  Session session(bus.exported);
  ASSERT_TRUE(session.receive(bytes_of(Operation{})));
  const Bytes answer = Bus::take(session);
  ASSERT_EQ(answer.size(), kOperationBytes + 4 + kDeviceBytes + kInterfaceBytes);
  EXPECT_EQ(Bytes(answer.end() - 4, answer.end()), from_hex("ff504100"));
  EXPECT_EQ(answer[kOperationBytes + 3], std::byte{1});
  EXPECT_EQ(Bytes(answer.end() - 16, answer.end() - 12), from_hex("12090001"));  // vendor, product
}

TEST(UsbipSession, only_one_client_has_the_device_and_leaving_gives_it_back) {
  Bus bus;
  Session other(bus.exported);
  {
    Attached* nobody = nullptr;
    static_cast<void>(nobody);
    Session first(bus.exported);
    ASSERT_TRUE(first.receive(test::import_request()));
    EXPECT_TRUE(first.attached());
    ASSERT_TRUE(other.receive(test::import_request()));
    EXPECT_FALSE(other.attached());
    EXPECT_EQ(Bus::take(other), bytes_of(Operation{kVersion, Code::import_reply, 1}));
    ASSERT_TRUE(other.receive(bytes_of(Operation{})));
    EXPECT_EQ(Bus::take(other).size(), kOperationBytes + 4);  // none to be had
  }
  ASSERT_TRUE(other.receive(test::import_request()));
  EXPECT_TRUE(other.attached());
}

TEST(UsbipSession, device_that_is_not_there_is_refused) {
  Bus bus;
  Session session(bus.exported);
  Bytes request = test::import_request();
  request[10] = std::byte{'2'};
  ASSERT_TRUE(session.receive(request));
  EXPECT_FALSE(session.attached());
  EXPECT_EQ(Bus::take(session), bytes_of(Operation{kVersion, Code::import_reply, 1}));
}

TEST(UsbipSession, standard_requests_enumerate_the_device) {
  Attached bus;
  const auto descriptor = bus.ask(bus.control("8006000100001200", true, 18));
  ASSERT_EQ(descriptor.size(), kTransferHeaderBytes + 18);
  EXPECT_EQ(std::to_integer<int>(descriptor[kTransferHeaderBytes + 1]), 1);
  // A host asks for the head first, and for more than there is.
  EXPECT_EQ(bus.ask(bus.control("8006000200000900", true, 9)).size(), kTransferHeaderBytes + 9);
  EXPECT_EQ(bus.ask(bus.control("800600020000ff00", true, 255)).size(),
            kTransferHeaderBytes + bus.device.descriptors().configuration.size());
  const auto serial = bus.ask(bus.control("800602030904ff00", true, 255));
  ASSERT_EQ(serial.size(), kTransferHeaderBytes + 2 + 2 * 7);
  EXPECT_EQ(static_cast<char>(serial[kTransferHeaderBytes + 2]), 'S');
  EXPECT_EQ(Attached::header_of(bus.ask(bus.control("0009010000000000", false, 0))).status, kDone);
  EXPECT_EQ(Attached::header_of(bus.ask(bus.control("8006000600000a00", true, 10))).status,
            kStalled);  // no device qualifier
  EXPECT_EQ(Attached::header_of(bus.ask(bus.control("c101008100004000", true, 64))).length, 64u);
}

TEST(UsbipSession, readings_come_to_the_transfers_that_wait_for_them_in_order) {
  Attached bus;
  bus.take(bus.session);
  std::vector<std::uint32_t> waiting;
  for (int i = 0; i < 4; ++i) {
    const TransferHeader h = bus.transfer(1, true, 64);
    waiting.push_back(h.sequence);
    bus.ask(h);
  }
  bus.live(kMs);
  bus.session.serve();
  // Whatever was ready went to the first; one reading is ready at a time.
  Bytes answers = bus.take(bus.session);
  for (int i = 0; i < 3; ++i) {
    bus.live(kMs);
    bus.session.serve();
    const Bytes more = bus.take(bus.session);
    answers.insert(answers.end(), more.begin(), more.end());
  }
  for (std::size_t at = 0; at < answers.size(); at += kTransferHeaderBytes + 64) {
    const TransferHeader h = Attached::header_of(
        Bytes(answers.begin() + static_cast<std::ptrdiff_t>(at), answers.end()));
    EXPECT_EQ(h.length, 64u);
    EXPECT_GE(h.sequence, waiting.front());
    protocol::State state;
    EXPECT_EQ(
        protocol::decode(std::span<const std::byte>(answers).subspan(at + kTransferHeaderBytes, 64),
                         state),
        protocol::PacketError::none);
  }
}

TEST(UsbipSession, transfer_given_up_is_said_so_once_and_never_answered) {
  Attached bus;
  bus.device.set_silent(true);
  bus.ask(bus.transfer(1, true, 64));  // what was ready
  const TransferHeader waiting = bus.transfer(1, true, 64);
  EXPECT_TRUE(bus.ask(waiting).empty());
  TransferHeader unlink;
  unlink.command = Command::unlink;
  unlink.sequence = 100;
  unlink.victim = waiting.sequence;
  const auto answer = Attached::header_of(bus.ask(unlink));
  EXPECT_EQ(answer.command, Command::unlink_reply);
  EXPECT_EQ(answer.sequence, 100u);
  EXPECT_EQ(answer.status, kUnlinked);
  EXPECT_EQ(Attached::header_of(bus.ask(unlink)).status, kDone);
  bus.device.set_silent(false);
  bus.live(10 * kMs);
  bus.session.serve();
  EXPECT_TRUE(bus.take(bus.session).empty());
}

TEST(UsbipSession, transfers_to_no_endpoint_stall_and_small_ones_overflow) {
  Attached bus;
  EXPECT_EQ(Attached::header_of(bus.ask(bus.transfer(2, true, 64))).status, kStalled);
  const Bytes data(8);
  EXPECT_EQ(Attached::header_of(bus.ask(bus.transfer(3, false, 8), data)).status, kStalled);
  bus.live(kMs);
  const auto answer = Attached::header_of(bus.ask(bus.transfer(1, true, 16)));
  EXPECT_EQ(answer.status, kOverflow);
  EXPECT_EQ(answer.length, 16u);
}

TEST(UsbipSession, requests_that_contradict_themselves_stall) {
  Attached bus;
  EXPECT_EQ(Attached::header_of(bus.ask(bus.control("8006000100001200", false, 0))).status,
            kStalled);  // direction
  EXPECT_EQ(Attached::header_of(bus.ask(bus.control("8006000100001200", true, 8))).status,
            kStalled);  // length
}

TEST(UsbipSession, command_arrives_and_leaving_ends_the_force) {
  Bus bus;
  {
    Session session(bus.exported);
    ASSERT_TRUE(session.receive(test::import_request()));
    TransferHeader begin;
    const Bytes setup = from_hex("4102010000000000");
    std::copy(setup.begin(), setup.end(), begin.setup.begin());
    ASSERT_TRUE(session.receive(bytes_of(begin)));
    protocol::Command command = protocol::test::some_command();
    command.answers = 1;
    command.force_uN = {1'000'000, 0, 0};
    TransferHeader out;
    out.endpoint = 1;
    out.length = protocol::kPacketBytes;
    ASSERT_TRUE(session.receive(bytes_of(out, protocol::encode(command))));
    bus.live(kMs);
    EXPECT_NEAR(norm(bus.device.rendered().force_N), 1.0, 1e-6);
  }
  bus.live(kMs);
  EXPECT_EQ(norm(bus.device.rendered().force_N), 0.0);
}

/// What a client says in a whole visit.
Bytes a_visit() {
  Bytes all = test::import_request();
  const auto say = [&](const Bytes& more) { all.insert(all.end(), more.begin(), more.end()); };
  TransferHeader h;
  h.is_in = true;
  h.length = 18;
  const Bytes setup = from_hex("8006000100001200");
  std::copy(setup.begin(), setup.end(), h.setup.begin());
  say(bytes_of(h));
  TransferHeader out;
  out.sequence = 2;
  out.endpoint = 1;
  out.length = 64;
  say(bytes_of(out, Bytes(64)));
  TransferHeader in = out;
  in.sequence = 3;
  in.is_in = true;
  say(bytes_of(in));
  TransferHeader unlink;
  unlink.command = Command::unlink;
  unlink.victim = 3;
  say(bytes_of(unlink));
  return all;
}

TEST(UsbipSession, messages_may_be_cut_and_merged_anywhere) {
  const Bytes visit = a_visit();
  const auto answers = [&](std::size_t piece) {
    Bus bus;
    Session session(bus.exported);
    for (std::size_t at = 0; at < visit.size(); at += piece) {
      EXPECT_TRUE(
          session.receive(std::span(visit).subspan(at, std::min(piece, visit.size() - at))));
    }
    return Bus::take(session);
  };
  const Bytes whole = answers(visit.size());
  EXPECT_FALSE(whole.empty());
  for (std::size_t piece = 1; piece < visit.size(); ++piece) ASSERT_EQ(answers(piece), whole);
}

TEST(UsbipSession, every_change_of_a_byte_ends_in_an_answer_or_a_closed_connection) {
  const Bytes visit = a_visit();
  for (std::size_t at = 0; at < visit.size(); ++at) {
    for (unsigned change = 1; change < 256; change += change < 8 ? 1 : 31) {
      Bus bus;
      Session session(bus.exported);
      Bytes bad = visit;
      bad[at] ^= static_cast<std::byte>(change);
      static_cast<void>(session.receive(bad));
      bus.live(kMs);
      session.serve();
      ASSERT_LT(session.output().size(), 4096u);
    }
  }
}

TEST(UsbipSession, whoever_asks_for_too_much_is_closed) {
  {
    Attached bus;
    EXPECT_FALSE(
        bus.session.receive(bytes_of(bus.transfer(1, true, Session::kMaxTransferBytes + 1))));
  }
  {
    Attached bus;
    bus.device.set_silent(true);
    bus.ask(bus.transfer(1, true, 64));
    for (std::size_t i = 0; i < Session::kMaxPending; ++i) {
      EXPECT_TRUE(bus.session.receive(bytes_of(bus.transfer(1, true, 64))));
    }
    EXPECT_FALSE(bus.session.receive(bytes_of(bus.transfer(1, true, 64))));
  }
  Bus bus;
  Session session(bus.exported);
  EXPECT_FALSE(session.receive(bytes_of(Operation{0x0110, Code::list_request})));  // version
}

}  // namespace
}  // namespace palpate::hal::usbip
