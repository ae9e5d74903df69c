// SPDX-License-Identifier: Apache-2.0
#include "hal/signature/field.hpp"

#include "hal/protocol/bytes.hpp"

namespace palpate::hal::signature {
namespace {

constexpr std::size_t kLimbs = 8;
/// 2^256 is 38 here: what leaves at the top comes in at the bottom, times this.
constexpr std::uint64_t kFold = 38;
constexpr Field kPrime{{0xffffffed, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff,
                        0xffffffff, 0x7fffffff}};

/// a + carry * 2^256, brought below 2^256. @param carry  below 2^38
Field folded(Field a, std::uint64_t carry) noexcept {
  // Twice: the first time may leave a carry of one, and then little is left below it.
  for (int round = 0; round < 2; ++round) {
    std::uint64_t sum = carry * kFold;
    for (std::uint32_t& limb : a.limbs) {
      sum += limb;
      limb = static_cast<std::uint32_t>(sum);
      sum >>= 32;
    }
    carry = sum;
  }
  return a;
}

/// a - b; true where it was below zero and is off by 2^256.
bool subtract(Field& a, const Field& b) noexcept {
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const std::uint64_t difference = std::uint64_t{a.limbs[i]} - b.limbs[i] - borrow;
    a.limbs[i] = static_cast<std::uint32_t>(difference);
    borrow = difference >> 63;
  }
  return borrow != 0;
}

}  // namespace

Field operator+(const Field& a, const Field& b) noexcept {
  Field out;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    sum += std::uint64_t{a.limbs[i]} + b.limbs[i];
    out.limbs[i] = static_cast<std::uint32_t>(sum);
    sum >>= 32;
  }
  return folded(out, sum);
}

Field operator-(const Field& a, const Field& b) noexcept {
  Field out = a;
  // A borrow has added 2^256, which is 38 here: that is taken away, and may borrow once more.
  constexpr Field kFoldField{{kFold}};
  if (subtract(out, b) && subtract(out, kFoldField)) static_cast<void>(subtract(out, kFoldField));
  return out;
}

Field operator*(const Field& a, const Field& b) noexcept {
  std::array<std::uint32_t, 2 * kLimbs> product{};
  for (std::size_t i = 0; i < kLimbs; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < kLimbs; ++j) {
      carry += std::uint64_t{a.limbs[i]} * b.limbs[j] + product[i + j];
      product[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product[i + kLimbs] = static_cast<std::uint32_t>(carry);
  }
  Field out;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    sum += product[i] + kFold * product[i + kLimbs];
    out.limbs[i] = static_cast<std::uint32_t>(sum);
    sum >>= 32;
  }
  return folded(out, sum);
}

Field squared(Field a, int n) noexcept {
  for (int i = 0; i < n; ++i) a = a * a;
  return a;
}

Field root_power(const Field& a) noexcept {
  // 2^252 - 3 = (2^250 - 1) * 4 + 1; ones(n) is a^(2^n - 1).
  const Field ones_2 = squared(a, 1) * a;
  const Field ones_4 = squared(ones_2, 2) * ones_2;
  const Field ones_5 = squared(ones_4, 1) * a;
  const Field ones_10 = squared(ones_5, 5) * ones_5;
  const Field ones_20 = squared(ones_10, 10) * ones_10;
  const Field ones_40 = squared(ones_20, 20) * ones_20;
  const Field ones_50 = squared(ones_40, 10) * ones_10;
  const Field ones_100 = squared(ones_50, 50) * ones_50;
  const Field ones_200 = squared(ones_100, 100) * ones_100;
  const Field ones_250 = squared(ones_200, 50) * ones_50;
  return squared(ones_250, 2) * a;
}

Field inverse(const Field& a) noexcept {
  // p - 2 = ((p - 5) / 8) * 8 + 3.
  return squared(root_power(a), 3) * squared(a, 1) * a;
}

Field reduced(Field a) noexcept {
  // Below 2^256 there are at most two primes to take away.
  for (int round = 0; round < 2; ++round) {
    Field less = a;
    if (!subtract(less, kPrime)) a = less;
  }
  return a;
}

Field from_bytes(std::span<const std::byte, 32> bytes) noexcept {
  Field out;
  for (std::size_t i = 0; i < kLimbs; ++i) out.limbs[i] = get<std::uint32_t>(bytes, 4 * i);
  return out;
}

std::array<std::byte, 32> to_bytes(const Field& a) noexcept {
  const Field one = reduced(a);
  std::array<std::byte, 32> out{};
  for (std::size_t i = 0; i < kLimbs; ++i) put(std::span<std::byte>(out), 4 * i, one.limbs[i]);
  return out;
}

}  // namespace palpate::hal::signature
