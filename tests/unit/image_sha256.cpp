// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {
namespace {

std::string hex_of(Sha256& hash) {
  std::string text;
  for (const std::uint8_t b : hash.finish()) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += kDigits[b >> 4];
    text += kDigits[b & 15];
  }
  return text;
}

std::string sha256(std::string_view text) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(text)));
  return hex_of(hash);
}

// FIPS 180-4 examples, as NIST publishes them.
TEST(Sha256, StandardExamples_give_their_digests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
                   "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu"),
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
}

TEST(Sha256, MillionLetters_give_their_digest) {
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, AnyDivisionIntoUpdates_gives_the_same_digest) {
  std::mt19937 random(1);
  const std::string text(1000, 'p');
  const std::string whole = sha256(text);
  for (int trial = 0; trial < 200; ++trial) {
    Sha256 hash;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t take = std::min<std::size_t>(rest.size(), random() % 150);
      hash.update(std::as_bytes(std::span(rest.substr(0, take))));
      rest.remove_prefix(take);
    }
    EXPECT_EQ(hex_of(hash), whole);
  }
}

// The padding has its corner cases around the end of a block; each length has its own digest.
TEST(Sha256, LengthsAroundABlock_give_distinct_digests) {
  std::vector<std::string> digests;
  for (std::size_t n = 50; n <= 130; ++n) digests.push_back(sha256(std::string(n, '\0')));
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::unique(digests.begin(), digests.end()), digests.end());
}

}  // namespace
}  // namespace palpate
