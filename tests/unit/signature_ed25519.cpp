// SPDX-License-Identifier: Apache-2.0
// Ed25519 and SHA-512: published vectors, another implementation, and what must be refused.
#include "hal/signature/ed25519.hpp"

#include <gtest/gtest.h>
#include <sodium.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "../support/signer.hpp"
#include "hal/signature/field.hpp"
#include "hal/signature/sha512.hpp"

namespace palpate::hal::signature {
namespace {

using Bytes = std::vector<std::byte>;
using test::raw;
using test::Signer;
using test::writable;

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

template <class Array>
Array array_of(const Bytes& bytes) {
  Array out{};
  EXPECT_EQ(bytes.size(), out.size());
  std::copy_n(bytes.begin(), std::min(bytes.size(), out.size()), out.begin());
  return out;
}

// RFC 8032, 7.1, TEST 1, 2, 3 and SHA(abc).
TEST(Ed25519, published_vectors_are_accepted) {
  const struct {
    const char *key, *message, *signature;
  } vectors[] = {{"d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a", "",
                  "e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33bac"
                  "c61e39701cf9b46b"
                  "d25bf5f0595bbe24655141438e7a100b"},
                 {"3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c", "72",
                  "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da085ac1e43e15996e"
                  "458f3613d0f11d8c"
                  "387b2eaeb4302aeeb00d291612bb0c00"},
                 {"fc51cd8e6218a1a38da47ed00230f0580816ed13ba3303ac5deb911548908025", "af82",
                  "6291d657deec24024827e69c3abe01a30ce548a284743a445e3680d7db5ac3ac18ff9b538d16f290"
                  "ae67f760984dc659"
                  "4a7c15e9716ed28dc027beceea1ec40a"},
                 {"ec172b93ad5e563bf4932c70e1245034c35467ef2efd4d64ebf819683467e2bf",
                  "ddaf35a193617abacc417349ae20413112e6fa4e89a97ea20a9eeee64b55d39a2192992a274fc1a8"
                  "36ba3c23a3feebbd"
                  "454d4423643ce80e2a9ac94fa54ca49f",
                  "dc2a4459e7369633a52b1bf277839a00201009a3efbf3ecb69bea2186c26b58909351fc9ac90b3ec"
                  "fdfbc7c66431e030"
                  "3dca179c138ac17ad9bef1177331a704"}};
  for (const auto& v : vectors) {
    EXPECT_TRUE(verify(array_of<PublicKey>(from_hex(v.key)), from_hex(v.message),
                       array_of<Signature>(from_hex(v.signature))))
        << v.message;
  }
}

TEST(Sha512, agrees_with_another_implementation_at_every_length_around_a_block) {
  std::mt19937 random(1);
  for (std::size_t length = 0; length < 400; ++length) {
    Bytes message(length);
    for (std::byte& b : message) b = static_cast<std::byte>(random());
    Sha512 hash;
    const std::size_t cut = length == 0 ? 0 : random() % length;
    hash.update(std::span(message).first(cut));
    hash.update(std::span(message).subspan(cut));
    std::array<std::byte, 64> right{};
    crypto_hash_sha512(writable(right), raw(message), length);
    ASSERT_EQ(hash.finish(), right) << length;
  }
}

TEST(Ed25519, signatures_of_another_implementation_are_accepted) {
  std::mt19937 random(2);
  for (unsigned i = 0; i < 200; ++i) {
    const Signer signer(static_cast<unsigned char>(i));
    Bytes message(random() % 300);
    for (std::byte& b : message) b = static_cast<std::byte>(random());
    ASSERT_TRUE(verify(signer.key, message, signer.sign(message))) << i;
  }
}

TEST(Ed25519, every_changed_bit_of_signature_key_and_message_is_refused) {
  const Signer signer(7);
  const Bytes message(40, std::byte{0x5a});
  const Signature right = signer.sign(message);
  for (std::size_t bit = 0; bit < 8 * kSignatureBytes; ++bit) {
    Signature bad = right;
    bad[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    ASSERT_FALSE(verify(signer.key, message, bad)) << bit;
  }
  for (std::size_t bit = 0; bit < 8 * kPublicKeyBytes; ++bit) {
    PublicKey bad = signer.key;
    bad[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    ASSERT_FALSE(verify(bad, message, right)) << bit;
  }
  for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
    Bytes bad = message;
    bad[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    ASSERT_FALSE(verify(signer.key, bad, right)) << bit;
  }
}

// The same signature with the order added to S: another one for the same message, to be refused.
TEST(Ed25519, second_form_of_a_signature_is_refused) {
  const Bytes order = from_hex("edd3f55c1a631258d69cf7a2def9de1400000000000000000000000000000010");
  const Signer signer(3);
  Signature bad = signer.sign({});
  unsigned carry = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    carry += std::to_integer<unsigned>(bad[32 + i]) + std::to_integer<unsigned>(order[i]);
    bad[32 + i] = static_cast<std::byte>(carry & 0xff);
    carry >>= 8;
  }
  EXPECT_FALSE(verify(signer.key, {}, bad));
}

// Points whose order divides eight, and numbers that are no point or not in their one form: with
// such a key, or R, anything could pass.
TEST(Ed25519, weak_and_false_keys_are_refused_as_libsodium_does) {
  const char* const keys[] = {"0100000000000000000000000000000000000000000000000000000000000000",
                              "0100000000000000000000000000000000000000000000000000000000000080",
                              "0000000000000000000000000000000000000000000000000000000000000000",
                              "0000000000000000000000000000000000000000000000000000000000000080",
                              "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
                              "edffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
                              "eeffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
                              "26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc05",
                              "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac037a",
                              "0200000000000000000000000000000000000000000000000000000000000000"};
  std::mt19937 random(5);
  for (const char* hex : keys) {
    const auto key = array_of<PublicKey>(from_hex(hex));
    for (int i = 0; i < 20; ++i) {
      Signature signature{};  // S = 0, R neutral: right for a neutral key
      signature[0] = std::byte{1};
      const Bytes message(1 + random() % 8, static_cast<std::byte>(i));
      EXPECT_FALSE(verify(key, message, signature)) << hex;
      EXPECT_NE(crypto_sign_verify_detached(raw(signature), raw(message), message.size(), raw(key)),
                0);
    }
  }
}

TEST(Field, arithmetic_holds_at_the_ends_of_its_range) {
  Field all_ones;
  all_ones.limbs.fill(0xffffffff);
  const Field prime{{0xffffffed, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff,
                     0xffffffff, 0x7fffffff}};
  const Field numbers[] = {kZero, kOne,         Field{{18}},  Field{{37}}, Field{{38}},
                           prime, prime - kOne, prime + kOne, all_ones,    all_ones - kOne};
  for (const Field& a : numbers) {
    EXPECT_TRUE(same(a - a, kZero));
    EXPECT_TRUE(same(kZero - (kZero - a), a));
    EXPECT_TRUE(same(a * inverse(a), same(a, kZero) ? kZero : kOne));
    for (const Field& b : numbers) {
      EXPECT_TRUE(same((a + b) - b, a));
      EXPECT_TRUE(same(a * b, b * a));
      for (const Field& c : numbers) EXPECT_TRUE(same(a * (b + c), a * b + a * c));
    }
  }
  EXPECT_TRUE(same(prime, kZero));
  EXPECT_TRUE(same(all_ones, Field{{37}}));
}

}  // namespace
}  // namespace palpate::hal::signature
