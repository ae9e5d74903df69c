// SPDX-License-Identifier: Apache-2.0
#include "hal/signature/ed25519.hpp"

#include <optional>

#include "hal/protocol/bytes.hpp"
#include "hal/signature/field.hpp"
#include "hal/signature/sha512.hpp"

namespace palpate::hal::signature {
namespace {

constexpr std::size_t kBits = 256;
constexpr Field kD{{0x135978a3, 0x75eb4dca, 0x4141d8ab, 0x00700a4d, 0x7779e898, 0x8cc74079,
                    0x2b6ffe73, 0x52036cee}};  // -121665 / 121666
constexpr Field kTwiceD{{0x26b2f159, 0xebd69b94, 0x8283b156, 0x00e0149a, 0xeef3d130, 0x198e80f2,
                         0x56dffce7, 0x2406d9dc}};
constexpr Field kRootOfMinusOne{{0x4a0ea0b0, 0xc4ee1b27, 0xad2fe478, 0x2f431806, 0x3dfbd7a7,
                                 0x2b4d0099, 0x4fc1df0b, 0x2b832480}};

/// A point x = X / Z, y = Y / Z, with T = X Y / Z.
struct Point {
  Field x = kZero;
  Field y = kOne;
  Field z = kOne;
  Field t = kZero;
};

constexpr Point kBase{{{0x8f25d51a, 0xc9562d60, 0x9525a7b2, 0x692cc760, 0xfdd6dc5c, 0xc0a4e231,
                        0xcd6e53fe, 0x216936d3}},
                      {{0x66666658, 0x66666666, 0x66666666, 0x66666666, 0x66666666, 0x66666666,
                        0x66666666, 0x66666666}},
                      kOne,
                      {{0xa5b7dda3, 0x6dde8ab3, 0x775152f5, 0x20f09f80, 0x64abe37d, 0x66ea4e8e,
                        0xd78b7665, 0x67875f0f}}};

/// The sum of any two points: the formulas have no exceptions on this curve.
Point operator+(const Point& p, const Point& q) noexcept {
  const Field a = (p.y - p.x) * (q.y - q.x);
  const Field b = (p.y + p.x) * (q.y + q.x);
  const Field c = p.t * kTwiceD * q.t;
  const Field zz = p.z * q.z;
  const Field d = zz + zz;
  const Field e = b - a;
  const Field f = d - c;
  const Field g = d + c;
  const Field h = b + a;
  return {e * f, g * h, f * g, e * h};
}

Point doubled(const Point& p) noexcept {
  const Field a = p.x * p.x;
  const Field b = p.y * p.y;
  const Field zz = p.z * p.z;
  const Field h = a + b;
  const Field e = h - (p.x + p.y) * (p.x + p.y);
  const Field g = a - b;
  const Field f = zz + zz + g;
  return {e * f, g * h, f * g, e * h};
}

std::array<std::byte, 32> encoded(const Point& p) noexcept {
  const Field over_z = inverse(p.z);
  std::array<std::byte, 32> out = to_bytes(p.y * over_z);
  const bool x_is_odd = (to_bytes(p.x * over_z)[0] & std::byte{1}) != std::byte{0};
  if (x_is_odd) out[31] |= std::byte{0x80};
  return out;
}

/// The point of an encoding; absent where there is none, or it is not the one encoding of its point
/// (RFC 8032, 5.1.3).
std::optional<Point> decoded(const PublicKey& bytes) noexcept {
  PublicKey y_bytes = bytes;
  y_bytes[31] &= std::byte{0x7f};
  Point p;
  p.y = from_bytes(y_bytes);
  const Field yy = p.y * p.y;
  const Field u = yy - kOne;
  const Field v = kD * yy + kOne;
  const Field v3 = v * v * v;
  p.x = u * v3 * root_power(u * v3 * v3 * v);
  const Field check = v * p.x * p.x;
  if (!same(check, u)) {
    if (!same(check, kZero - u)) return std::nullopt;
    p.x = p.x * kRootOfMinusOne;
  }
  const auto sign_of = [](const Field& x) { return to_bytes(x)[0] & std::byte{1}; };
  if (sign_of(p.x) != (bytes[31] >> 7)) p.x = kZero - p.x;
  p.t = p.x * p.y;
  if (encoded(p) != bytes) return std::nullopt;
  return p;
}

/// Eight times it is the neutral point: such a key signs anything.
bool is_of_small_order(const Point& p) noexcept {
  const Point eightfold = doubled(doubled(doubled(p)));
  return same(eightfold.x, kZero);
}

/// Numbers below 2^256 as the exponents that points are multiplied with.
using Scalar = std::array<std::uint32_t, 8>;

/// The order of the base point, 2^252 + 27742317777372353535851937790883648493.
constexpr Scalar kOrder{0x5cf5d3ed, 0x5812631a, 0xa2f79cd6, 0x14def9de,
                        0x00000000, 0x00000000, 0x00000000, 0x10000000};

bool is_below_order(const Scalar& a) noexcept {
  for (std::size_t i = a.size(); i-- > 0;) {
    if (a[i] != kOrder[i]) return a[i] < kOrder[i];
  }
  return false;
}

/// A number of 512 bits modulo the order, a bit at a time.
Scalar modulo_order(const std::array<std::byte, 64>& bytes) noexcept {
  Scalar rest{};
  for (std::size_t bit = 8 * bytes.size(); bit-- > 0;) {
    std::uint32_t carry = std::to_integer<std::uint32_t>(bytes[bit / 8] >> bit % 8) & 1;
    for (std::uint32_t& limb : rest) {
      const std::uint32_t out = limb >> 31;
      limb = limb << 1 | carry;
      carry = out;
    }
    // It was below the order, so it is below twice the order now.
    if (is_below_order(rest)) continue;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const std::uint64_t difference = std::uint64_t{rest[i]} - kOrder[i] - borrow;
      rest[i] = static_cast<std::uint32_t>(difference);
      borrow = difference >> 63;
    }
  }
  return rest;
}

bool bit_of(const Scalar& a, std::size_t bit) noexcept {
  return (a[bit / 32] >> bit % 32 & 1) != 0;
}

/// a P + b Q, both at once (Straus, 1964).
Point combined(const Scalar& a, const Point& p, const Scalar& b, const Point& q) noexcept {
  const Point both = p + q;
  Point sum;
  for (std::size_t bit = kBits; bit-- > 0;) {
    sum = doubled(sum);
    const bool with_p = bit_of(a, bit);
    const bool with_q = bit_of(b, bit);
    if (with_p || with_q) sum = sum + (with_p && with_q ? both : with_p ? p : q);
  }
  return sum;
}

}  // namespace

bool verify(const PublicKey& key, std::span<const std::byte> message,
            const Signature& signature) noexcept {
  const auto r = std::span<const std::byte>(signature).first<32>();
  const auto s = std::span<const std::byte>(signature).last<32>();
  const Scalar factor = from_bytes(s).limbs;
  const auto point = decoded(key);
  if (!is_below_order(factor) || !point || is_of_small_order(*point)) return false;
  Sha512 hash;
  hash.update(r);
  hash.update(key);
  hash.update(message);
  const Point minus_key{kZero - point->x, point->y, point->z, kZero - point->t};
  const auto right = encoded(combined(factor, kBase, modulo_order(hash.finish()), minus_key));
  bool same_bytes = true;
  for (std::size_t i = 0; i < right.size(); ++i) same_bytes = same_bytes && right[i] == r[i];
  return same_bytes;
}

}  // namespace palpate::hal::signature
