// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tools/live/address.hpp"

namespace palpate::live {
namespace {

std::vector<std::byte> with(std::size_t at, double value) {
  std::vector<std::byte> bytes = encode_lead({true, {{0.1, -0.2, 0.3}, {0.6, 0, 0.8, 0}}});
  std::memcpy(bytes.data() + 8 + 8 * at, &value, sizeof value);
  return bytes;
}

std::vector<std::byte> with_word(std::size_t at, std::uint32_t value) {
  std::vector<std::byte> bytes = encode_lead({});
  std::memcpy(bytes.data() + 4 * at, &value, sizeof value);
  return bytes;
}

TEST(LeadMessage, whole_one_is_understood) {
  const auto lead = parse_lead(encode_lead({true, {{0.1, -0.2, 0.3}, {0.6, 0, 0.8, 0}}}));
  ASSERT_TRUE(lead);
  EXPECT_TRUE(lead->held);
  EXPECT_EQ(lead->to.position_m, (Vec3d{0.1, -0.2, 0.3}));
  EXPECT_NEAR(lead->to.orientation.w, 0.6, 1e-15);
  EXPECT_NEAR(lead->to.orientation.y, 0.8, 1e-15);
}

TEST(LeadMessage, any_other_length_is_refused) {
  std::vector<std::byte> bytes = encode_lead({});
  ASSERT_EQ(bytes.size(), kLeadBytes);
  bytes.resize(200);
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    EXPECT_EQ(parse_lead(std::span(bytes).first(size)).has_value(), size == kLeadBytes) << size;
  }
}

TEST(LeadMessage, letting_go_is_understood_and_has_no_pose) {
  std::vector<std::byte> bytes = encode_lead({false, {}});
  ASSERT_EQ(bytes.size(), kLetGoBytes);
  const auto lead = parse_lead(bytes);
  ASSERT_TRUE(lead);
  EXPECT_FALSE(lead->held);
  bytes[0] = std::byte{1};
  EXPECT_FALSE(parse_lead(bytes));
  bytes = encode_lead({});
  bytes[0] = std::byte{2};
  EXPECT_FALSE(parse_lead(bytes));
}

TEST(LeadMessage, other_words_are_refused) {
  EXPECT_TRUE(parse_lead(with_word(0, 1)));
  EXPECT_FALSE(parse_lead(with_word(0, 0)));
  EXPECT_FALSE(parse_lead(with_word(0, 2)));
  EXPECT_FALSE(parse_lead(with_word(1, 1)));
}

TEST(LeadMessage, numbers_that_are_not_finite_are_refused) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(), 1e300}) {
    for (std::size_t at = 0; at < 7; ++at) EXPECT_FALSE(parse_lead(with(at, value))) << at;
  }
}

TEST(LeadMessage, what_is_too_far_or_no_rotation_is_refused) {
  EXPECT_TRUE(parse_lead(with(0, kFarthest_m)));
  EXPECT_FALSE(parse_lead(with(0, -1.001 * kFarthest_m)));
  EXPECT_FALSE(parse_lead(with(5, 0)));
  EXPECT_FALSE(parse_lead(with(5, 0.81)));
  const auto nearly = parse_lead(with(5, 0.8005));
  ASSERT_TRUE(nearly);
  const Quat& q = nearly->to.orientation;
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
}

TEST(Frame, has_its_head_samples_and_contacts) {
  Status status;
  status.tick.time_ns = 2'000'000'000;
  status.tick.position_m = {1, 2, 3.5};
  status.missed = 7;
  realtime::LiveTick contacts;
  contacts.shown = 2;
  contacts.found = 5;
  contacts.contacts[1].distance_m = -0.25f;
  contacts.contacts[1].force_N = 1.5f;
  std::vector<Sample> samples(3);
  samples[2].t_s = 1.5;
  std::vector<std::byte> out(10);
  encode_frame(status, samples, contacts, {1, 2, 3}, out);
  ASSERT_EQ(out.size(), 8 * kHeadNumbers + 3 * 8 * 4 + 2 * 8 * 4);
  std::vector<double> head(kHeadNumbers);
  std::memcpy(head.data(), out.data(), 8 * kHeadNumbers);
  EXPECT_EQ(head[0], 3);
  EXPECT_EQ(head[1], 2);
  EXPECT_EQ(head[2], 5);
  EXPECT_EQ(head[6], 2);
  EXPECT_EQ(head[8], 7);
  EXPECT_EQ(head[38], 0.5);  // of the hand, from the origin
  std::vector<float> rest((out.size() - 8 * kHeadNumbers) / 4);
  std::memcpy(rest.data(), out.data() + 8 * kHeadNumbers, 4 * rest.size());
  EXPECT_EQ(rest[16], -0.5f);
  EXPECT_EQ(rest[rest.size() - 2], -0.25f);
  EXPECT_EQ(rest.back(), 1.5f);
}

TEST(Address, token_is_long_and_another_each_time) {
  const std::string token = make_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_NE(token, make_token());
  EXPECT_TRUE(same_token(token, token));
  EXPECT_FALSE(same_token("", token));
  EXPECT_FALSE(same_token(token.substr(1), token));
  std::string other = token;
  other.back() = other.back() == '0' ? '1' : '0';
  EXPECT_FALSE(same_token(other, token));
}

TEST(Address, only_this_server_is_its_own) {
  for (const char* host : {"127.0.0.1:80", "localhost:80"}) {
    EXPECT_TRUE(is_own_host(host, 80));
    EXPECT_TRUE(is_own_origin(std::string("http://") + host, 80));
  }
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:81", "example.org:80", "localhost:8080",
                           "127.0.0.1:80.example.org"}) {
    EXPECT_FALSE(is_own_host(host, 80)) << host;
    EXPECT_FALSE(is_own_origin(std::string("http://") + host, 80)) << host;
  }
  for (const char* origin : {"", "null", "https://127.0.0.1:80", "127.0.0.1:80", "file://"}) {
    EXPECT_FALSE(is_own_origin(origin, 80)) << origin;
  }
}

}  // namespace
}  // namespace palpate::live
