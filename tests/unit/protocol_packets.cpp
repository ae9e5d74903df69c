// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/packets.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "../support/packets.hpp"
#include "../support/temporary_folder.hpp"
#include "hal/protocol/bytes.hpp"
#include "hal/protocol/crc32.hpp"

namespace palpate::hal::protocol {
namespace {

using namespace test;

std::string hex(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % 16 == 0 && i > 0) text += '\n';
    text += kDigits[std::to_integer<unsigned>(bytes[i]) >> 4];
    text += kDigits[std::to_integer<unsigned>(bytes[i]) & 15];
  }
  return text;
}

std::vector<Packet> one_of_each() {
  return {encode(some_state()),         encode(some_joint_state()),  encode(some_command()),
          encode(some_joint_command()), encode(some_capabilities()), encode(some_joint()),
          encode(some_identity())};
}

/// Whether any decoder takes the bytes.
bool is_accepted(std::span<const std::byte> bytes) {
  State s;
  Command c;
  Capabilities k;
  Joint j;
  ImageIdentity i;
  return decode(bytes, s) == PacketError::none || decode(bytes, c) == PacketError::none ||
         decode(bytes, k) == PacketError::none || decode(bytes, j) == PacketError::none ||
         decode(bytes, i) == PacketError::none;
}

Packet with_crc(Packet packet) {
  const auto body = std::span<const std::byte>(packet).first(60);
  put(std::span<std::byte>(packet), 60, ~crc32_update(kCrc32Start, body));
  return packet;
}

template <class T>
T round_trip(const T& value) {
  T back;
  EXPECT_EQ(decode(encode(value), back), PacketError::none);
  return back;
}

TEST(Crc32, check_value_of_the_catalogue_is_met) {
  const std::string text = "123456789";
  EXPECT_EQ(~crc32_update(kCrc32Start, std::as_bytes(std::span(text))), 0xcbf43926u);
}

// The CRCs were checked with another implementation (zlib).
constexpr const char* kGoldenState =
    "50700101040302011817161514131211\n"
    "40420f00807be1ff0094357730333333\n"
    "000000009c9999d90000000001000080\n"
    "4d0000000900020005000000dc9d0ced";
constexpr const char* kGoldenCommand =
    "5070014109000000204e000001000000\n"
    "60e3160060dad9ff03000000f6ffffff\n"
    "14000000e2ffffff0000000004030201\n"
    "fa00000000000000000000002231df5c";

TEST(Packets, golden_bytes_are_kept_and_stand_in_the_document) {
  EXPECT_EQ(hex(encode(some_state())), kGoldenState);
  EXPECT_EQ(hex(encode(some_command())), kGoldenCommand);
  const std::string page = palpate::test::read_file(PALPATE_DOCS "/PROTOCOL.md");
  EXPECT_NE(page.find(kGoldenState), std::string::npos);
  EXPECT_NE(page.find(kGoldenCommand), std::string::npos);
}

TEST(Packets, golden_checksums_of_every_type_are_kept) {
  std::vector<std::uint32_t> sums;
  for (const Packet& p : one_of_each()) sums.push_back(get<std::uint32_t>(p, 60));
  EXPECT_EQ(sums, (std::vector<std::uint32_t>{3977027036, 2036824611, 1558130978, 1608081901,
                                              3718751129, 4006805283, 4062932770}));
}

TEST(Packets, round_trip_keeps_every_field) {
  EXPECT_EQ(encode(round_trip(some_state())), encode(some_state()));
  EXPECT_EQ(encode(round_trip(some_joint_state())), encode(some_joint_state()));
  EXPECT_EQ(encode(round_trip(some_command())), encode(some_command()));
  EXPECT_EQ(encode(round_trip(some_joint_command())), encode(some_joint_command()));
  EXPECT_EQ(encode(round_trip(some_capabilities())), encode(some_capabilities()));
  EXPECT_EQ(encode(round_trip(some_joint())), encode(some_joint()));
  EXPECT_EQ(encode(round_trip(some_identity())), encode(some_identity()));
  const State s = round_trip(some_state());
  EXPECT_EQ(s.position_nm, some_state().position_nm);
  EXPECT_EQ(s.orientation, some_state().orientation);
  EXPECT_EQ(s.device_time_ns, some_state().device_time_ns);
  EXPECT_EQ(s.answered, 77u);
  EXPECT_EQ(s.mode, Mode::active);
  EXPECT_EQ(round_trip(some_joint()).max_counts, 2000);
}

TEST(Packets, every_other_length_is_refused) {
  for (const Packet& packet : one_of_each()) {
    std::vector<std::byte> longer(packet.begin(), packet.end());
    for (std::size_t length = 0; length < kPacketBytes; ++length) {
      // A buffer of its own, so that a sanitizer sees a read past its end.
      const std::vector<std::byte> prefix(longer.begin(), longer.begin() + std::ptrdiff_t(length));
      EXPECT_FALSE(is_accepted(prefix)) << length;
    }
    longer.push_back(std::byte{0});
    EXPECT_FALSE(is_accepted(longer));
  }
}

TEST(Packets, every_change_of_one_byte_is_refused) {
  for (const Packet& packet : one_of_each()) {
    for (std::size_t at = 0; at < kPacketBytes; ++at) {
      for (unsigned change = 1; change < 256; ++change) {
        Packet bad = packet;
        bad[at] ^= std::byte(change);
        EXPECT_FALSE(is_accepted(bad)) << at << " ^ " << change;
      }
    }
  }
}

// All of them at once: the CRC is linear, so that a change goes unnoticed in one packet where it
// does in all. Two changed bytes go unnoticed where each changes the checksum alike: 131 million
// pairs.
TEST(Packets, no_change_of_two_bytes_leaves_the_checksum_right) {
  const Packet zero = with_crc({});
  const auto effect_of = [&](std::size_t at, unsigned change) {
    Packet changed = zero;
    changed[at] ^= std::byte(change);
    const Packet right = with_crc(changed);
    const std::span<const std::byte> is(changed), should_be(right);
    return get<std::uint32_t>(is, kPacketBytes - 4) ^
           get<std::uint32_t>(should_be, kPacketBytes - 4);
  };
  std::vector<std::uint32_t> effects;
  for (std::size_t at = 0; at < kPacketBytes; ++at) {
    for (unsigned change = 1; change < 256; ++change) effects.push_back(effect_of(at, change));
  }
  std::sort(effects.begin(), effects.end());
  EXPECT_NE(effects.front(), 0u);
  EXPECT_EQ(std::adjacent_find(effects.begin(), effects.end()), effects.end());
  EXPECT_EQ(effects.size(), kPacketBytes * 255);
}

TEST(Packets, every_change_of_two_bits_and_random_changes_of_two_bytes_are_refused) {
  std::mt19937 random(3);
  for (const Packet& packet : one_of_each()) {
    for (std::size_t one = 0; one < kPacketBytes * 8; ++one) {
      for (std::size_t two = 0; two < one; ++two) {
        Packet bad = packet;
        bad[one / 8] ^= std::byte(1u << one % 8);
        bad[two / 8] ^= std::byte(1u << two % 8);
        ASSERT_FALSE(is_accepted(bad)) << one << " " << two;
      }
    }
    for (int i = 0; i < 200'000; ++i) {
      Packet bad = packet;
      const std::size_t at = random() % kPacketBytes;
      bad[at] ^= std::byte(1 + random() % 255);
      bad[(at + 1 + random() % (kPacketBytes - 1)) % kPacketBytes] ^= std::byte(1 + random() % 255);
      ASSERT_FALSE(is_accepted(bad));
    }
  }
}

TEST(Packets, whatever_is_accepted_is_encoded_to_the_same_bytes) {
  std::mt19937 random(4);
  int accepted = 0;
  for (int i = 0; i < 200'000; ++i) {
    Packet bad = encode(some_state());
    for (auto n = random() % 3 + 1; n > 0; --n) {
      bad[4 + random() % 56] = static_cast<std::byte>(random() % 4 == 0 ? random() : 0);
    }
    bad = with_crc(bad);
    State s;
    if (decode(bad, s) != PacketError::none) continue;
    ++accepted;
    ASSERT_EQ(encode(s), bad);
  }
  EXPECT_GT(accepted, 10'000);
}

TEST(Packets, reasons_of_a_refusal_are_told_apart) {
  State out;
  Packet p = encode(some_state());
  const auto reason = [&](std::size_t at, std::uint8_t value) {
    Packet bad = p;
    put(std::span<std::byte>(bad), at, value);
    return decode(with_crc(bad), out);
  };
  EXPECT_EQ(decode({}, out), PacketError::size);
  EXPECT_EQ(reason(0, 'Q'), PacketError::magic);
  EXPECT_EQ(reason(2, 2), PacketError::version);
  EXPECT_EQ(reason(3, 0x41), PacketError::type);
  EXPECT_EQ(reason(55, 1), PacketError::reserved);
  EXPECT_EQ(reason(54, 5), PacketError::range);  // no such mode
  p[20] ^= std::byte{1};
  EXPECT_EQ(decode(p, out), PacketError::crc);
}

TEST(Packets, orientation_far_from_unit_length_is_refused) {
  State out;
  State s = some_state();
  s.orientation = {};
  EXPECT_EQ(decode(encode(s), out), PacketError::range);
  s.orientation = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
  EXPECT_EQ(decode(encode(s), out), PacketError::range);
  s.orientation = {kUnitQuaternion + kUnitQuaternion / 2048, 0, 0, 0};
  EXPECT_EQ(decode(encode(s), out), PacketError::none);
  s.orientation = {kUnitQuaternion - kUnitQuaternion / 512, 0, 0, 0};
  EXPECT_EQ(decode(encode(s), out), PacketError::range);
}

TEST(Packets, command_without_life_or_with_too_long_a_one_is_refused) {
  Command out;
  Command c = some_command();
  for (const std::uint32_t life_us : {0u, kMaxCommandLife_us + 1, ~0u}) {
    c.life_us = life_us;
    EXPECT_EQ(decode(encode(c), out), PacketError::range);
  }
}

TEST(Packets, order_of_sequences_survives_the_wrap) {
  EXPECT_TRUE(is_after(2, 1));
  EXPECT_FALSE(is_after(1, 1));
  EXPECT_FALSE(is_after(1, 2));
  EXPECT_TRUE(is_after(3, 0xfffffffeu));
  EXPECT_FALSE(is_after(0xfffffffeu, 3));
}

}  // namespace
}  // namespace palpate::hal::protocol
