// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/sha256.hpp"

#include <bit>
#include <cstring>

#include "rt_core/base/assert.hpp"

namespace palpate {
namespace {

using Word = std::uint32_t;

// FIPS 180-4, Sec. 4.2.2: the first 32 bits of the fractional parts of the cube roots of the first
// 64 primes.
constexpr Word kRoundConstants[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

constexpr std::size_t kBlockBytes = 64;
constexpr std::size_t kLengthOffset = 56;  // of the message length in the last block

Word load_big_endian(const std::byte* p) noexcept {
  return std::to_integer<Word>(p[0]) << 24 | std::to_integer<Word>(p[1]) << 16 |
         std::to_integer<Word>(p[2]) << 8 | std::to_integer<Word>(p[3]);
}

// One round of Sec. 6.2.2, step 3. The caller rotates the names of the variables instead of their
// values.
inline void round(Word a, Word b, Word c, Word& d, Word e, Word f, Word g, Word& h,
                  Word input) noexcept {
  const Word choice = g ^ (e & (f ^ g));
  const Word majority = (a & b) | (c & (a | b));
  const Word t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + choice + input;
  d += t1;
  h = t1 + (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + majority;
}

inline void eight_rounds(Word (&v)[8], const Word* k, const Word* w) noexcept {
  round(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], k[0] + w[0]);
  round(v[7], v[0], v[1], v[2], v[3], v[4], v[5], v[6], k[1] + w[1]);
  round(v[6], v[7], v[0], v[1], v[2], v[3], v[4], v[5], k[2] + w[2]);
  round(v[5], v[6], v[7], v[0], v[1], v[2], v[3], v[4], k[3] + w[3]);
  round(v[4], v[5], v[6], v[7], v[0], v[1], v[2], v[3], k[4] + w[4]);
  round(v[3], v[4], v[5], v[6], v[7], v[0], v[1], v[2], k[5] + w[5]);
  round(v[2], v[3], v[4], v[5], v[6], v[7], v[0], v[1], k[6] + w[6]);
  round(v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[0], k[7] + w[7]);
}

}  // namespace

void Sha256::block(const std::byte* data) noexcept {
  Word w[64];
  for (std::size_t i = 0; i < 16; ++i) w[i] = load_big_endian(data + 4 * i);
  for (std::size_t i = 16; i < 64; ++i) {
    const Word s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ (w[i - 15] >> 3);
    const Word s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ (w[i - 2] >> 10);
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  Word v[8];
  for (std::size_t i = 0; i < 8; ++i) v[i] = state_[i];
  for (std::size_t i = 0; i < 64; i += 8) eight_rounds(v, kRoundConstants + i, w + i);
  for (std::size_t i = 0; i < 8; ++i) state_[i] += v[i];
}

void Sha256::update(std::span<const std::byte> data) noexcept {
  total_ += data.size();
  if (buffered_ > 0) {
    const std::size_t room = kBlockBytes - buffered_;
    const std::size_t taken = data.size() < room ? data.size() : room;
    if (taken > 0) std::memcpy(buffer_ + buffered_, data.data(), taken);
    buffered_ += taken;
    data = data.subspan(taken);
    if (buffered_ < kBlockBytes) return;
    block(buffer_);
    buffered_ = 0;
  }
  for (; data.size() >= kBlockBytes; data = data.subspan(kBlockBytes)) block(data.data());
  if (!data.empty()) std::memcpy(buffer_, data.data(), data.size());
  buffered_ = data.size();
}

std::array<std::uint8_t, 32> Sha256::finish() noexcept {
  PALPATE_ASSERT(buffered_ < kBlockBytes);
  const std::uint64_t bits = total_ * 8;
  buffer_[buffered_++] = std::byte{0x80};
  if (buffered_ > kLengthOffset) {
    std::memset(buffer_ + buffered_, 0, kBlockBytes - buffered_);
    block(buffer_);
    buffered_ = 0;
  }
  std::memset(buffer_ + buffered_, 0, kLengthOffset - buffered_);
  for (std::size_t i = 0; i < 8; ++i) {
    buffer_[kLengthOffset + i] = static_cast<std::byte>(bits >> (56 - 8 * i));
  }
  block(buffer_);
  std::array<std::uint8_t, 32> digest{};
  for (std::size_t i = 0; i < 32; ++i) {
    digest[i] = static_cast<std::uint8_t>(state_[i / 4] >> (24 - 8 * (i % 4)));
  }
  return digest;
}

}  // namespace palpate
