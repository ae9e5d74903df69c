// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::hal::falcon {
namespace {

std::string text(const Message& m) {
  std::string out;
  for (const std::byte b : m) out += static_cast<char>(b);
  return out;
}

std::size_t feed(ReplyParser& parser, std::string_view bytes) {
  return parser.feed(std::as_bytes(std::span(bytes)));
}

Reply reply(std::int16_t a, std::int16_t b, std::int16_t c, std::uint8_t buttons = 0) {
  return {{a, b, c}, buttons, 7};
}

TEST(FalconMessages, null_request_is_the_published_one) {
  EXPECT_EQ(text(encode(Request{})), "<AAAAAAAAAAAAAA>");
}

TEST(FalconMessages, numbers_are_nibbles_lowest_first) {
  Request request;
  request.motors = {0x123, -1, 0};
  request.homing = true;
  request.leds = 0x4;
  EXPECT_EQ(text(encode(request)), "<DCBAPPPPAAAAFA>");
}

TEST(FalconMessages, motors_are_clamped_before_they_are_encoded) {
  Request request, back;
  request.motors = {32767, -32768, 4096};
  ASSERT_TRUE(decode(encode(request), back));
  EXPECT_EQ(back.motors, (MotorValues{4095, -4095, 4095}));
}

TEST(FalconMessages, round_trip_keeps_replies) {
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Reply r{{static_cast<std::int16_t>(random()), static_cast<std::int16_t>(random()),
                   static_cast<std::int16_t>(random())},
                  static_cast<std::uint8_t>(random() & 15),
                  static_cast<std::uint8_t>(random() & 7)};
    Reply back;
    ASSERT_TRUE(decode(encode(r), back));
    ASSERT_EQ(back.counts, r.counts);
    ASSERT_EQ(back.buttons, r.buttons);
    ASSERT_EQ(back.homed, r.homed);
  }
}

TEST(FalconParser, reply_is_found_however_it_is_cut) {
  const std::string stream = text(encode(reply(1, 2, 3))) + text(encode(reply(4, 5, 6)));
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    ReplyParser parser;
    const std::size_t first = feed(parser, stream.substr(0, cut));
    EXPECT_EQ(first, cut / 16);
    EXPECT_EQ(first + feed(parser, stream.substr(cut)), 2u);
    EXPECT_EQ(parser.newest().counts, (EncoderCounts{4, 5, 6}));
    EXPECT_EQ(parser.skipped(), 0u);
  }
}

// A 14-byte reply was once taken for a whole one because of the '>' of the reply before.
TEST(FalconParser, short_reply_is_never_filled_up_from_an_old_one) {
  ReplyParser parser;
  EXPECT_EQ(feed(parser, text(encode(reply(1, 2, 3)))), 1u);
  EXPECT_EQ(feed(parser, text(encode(reply(9, 9, 9, 15))).substr(0, 14)), 0u);
  EXPECT_EQ(feed(parser, text(encode(reply(4, 5, 6)))), 1u);
  EXPECT_EQ(parser.newest().counts, (EncoderCounts{4, 5, 6}));
  EXPECT_EQ(parser.newest().buttons, 0);
}

TEST(FalconParser, every_lost_or_changed_byte_costs_at_most_the_reply_that_it_was_in) {
  const std::string good = text(encode(reply(0x1234, -77, 5)));
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int value = -1; value < 256; ++value) {
      std::string bad = good;
      if (value < 0) {
        bad.erase(at, 1);
      } else {
        bad[at] = static_cast<char>(value);
      }
      ReplyParser parser;
      feed(parser, bad);
      EXPECT_GE(feed(parser, good + good), 1u) << at << " " << value;
      EXPECT_EQ(parser.newest().counts, (EncoderCounts{0x1234, -77, 5}));
    }
  }
}

TEST(FalconParser, restart_forgets_a_reply_that_has_begun) {
  ReplyParser parser;
  const std::string good = text(encode(reply(1, 2, 3)));
  feed(parser, good.substr(0, 8));
  parser.restart();
  EXPECT_EQ(feed(parser, good.substr(8)), 0u);
  EXPECT_EQ(feed(parser, good), 1u);
  EXPECT_EQ(parser.skipped(), 16u);
}

TEST(FalconParser, resynchronises_in_random_bytes_within_one_reply) {
  std::mt19937 random(2);
  const std::string good = text(encode(reply(10, 20, 30)));
  for (int round = 0; round < 20'000; ++round) {
    ReplyParser parser;
    std::string noise;
    // '<' often: the worst for a parser that hunts for it.
    for (auto n = random() % 40; n > 0; --n) {
      noise += random() % 3 == 0 ? '<' : static_cast<char>(random());
    }
    feed(parser, noise);
    const std::size_t found = feed(parser, good + good);
    ASSERT_GE(found, 1u);
    ASSERT_EQ(parser.newest().counts, (EncoderCounts{10, 20, 30}));
  }
}

}  // namespace
}  // namespace palpate::hal::falcon
