// SPDX-License-Identifier: Apache-2.0
// Lanes of floats, as wide as the translation unit's target allows. Private to source files.
//
// GCC's and Clang's vector types instead of a library: every operation is IEEE, lane by lane, in
// the order in which it is written, so that 4, 8 and 16 lanes give the same bits, and one lane of
// plain floats does, for targets without vectors: a quarter of the code that compilers make of four
// lanes there. All of it is in an unnamed namespace:
// the kernels are compiled several times with different instruction sets, and no function of one
// may be linked into another.
#pragma once

#include <bit>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

/// Whether this translation unit has lanes: the target has, and the one without did not ask.
#if !defined(PALPATE_SCALAR) && (defined(__SSE2__) || defined(__ARM_NEON))
#define PALPATE_VECTORS 1
#else
#define PALPATE_VECTORS 0
#endif

namespace palpate::regions {
namespace {

#define PALPATE_LANES [[gnu::always_inline]] inline

#if PALPATE_VECTORS

#if defined(__AVX512F__)
inline constexpr int kLanes = 16;
#elif defined(__AVX2__)
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;
#endif

using Floats = float __attribute__((vector_size(sizeof(float) * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(sizeof(std::int32_t) * kLanes)));

/// Four floats that lie in a row, on every target with lanes.
using Four = float __attribute__((vector_size(4 * sizeof(float))));

PALPATE_LANES Four four(const float* from) noexcept {
  Four v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
PALPATE_LANES Floats load(const float* from) noexcept {
  Floats v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
PALPATE_LANES Ints load(const std::int32_t* from) noexcept {
  Ints v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <class Vector>
PALPATE_LANES void store(Vector v, float* to) noexcept {
  __builtin_memcpy(to, &v, sizeof v);
}
PALPATE_LANES void store(Ints v, std::int32_t* to) noexcept { __builtin_memcpy(to, &v, sizeof v); }
PALPATE_LANES Floats all(float v) noexcept { return v - Floats{}; }
PALPATE_LANES Ints all(std::int32_t v) noexcept { return v - Ints{}; }
/// 0, 1, 2 and so on.
PALPATE_LANES Ints counting() noexcept {
  Ints v;
  for (int i = 0; i < kLanes; ++i) v[i] = i;
  return v;
}

PALPATE_LANES Floats magnitude(Floats v) noexcept {
  return reinterpret_cast<Floats>(reinterpret_cast<Ints>(v) & 0x7fffffff);
}

/// Towards zero; of what an int holds.
PALPATE_LANES Ints truncated(Floats v) noexcept { return __builtin_convertvector(v, Ints); }

/// Four floats from each of kLanes / 4 places. The functions below are about every four lanes by
/// themselves.
PALPATE_LANES Floats fours(const float* const (&from)[kLanes / 4]) noexcept;
/// Of 0123 and 4567: 0415 and 2637.
PALPATE_LANES Floats low_mixed(Floats a, Floats b) noexcept;
PALPATE_LANES Floats high_mixed(Floats a, Floats b) noexcept;
/// 0145 and 2367.
PALPATE_LANES Floats low_halves(Floats a, Floats b) noexcept;
PALPATE_LANES Floats high_halves(Floats a, Floats b) noexcept;

#if defined(__AVX512F__)
// Masked, with all lanes: without a mask the header of GCC 12 warns of itself.
PALPATE_LANES Floats fours(const float* const (&from)[4]) noexcept {
  __m512 v = _mm512_maskz_broadcast_f32x4(0xffff, four(from[0]));
  v = _mm512_maskz_insertf32x4(0xffff, v, four(from[1]), 1);
  v = _mm512_maskz_insertf32x4(0xffff, v, four(from[2]), 2);
  return _mm512_maskz_insertf32x4(0xffff, v, four(from[3]), 3);
}
PALPATE_LANES Floats low_mixed(Floats a, Floats b) noexcept {
  return _mm512_maskz_unpacklo_ps(0xffff, a, b);
}
PALPATE_LANES Floats high_mixed(Floats a, Floats b) noexcept {
  return _mm512_maskz_unpackhi_ps(0xffff, a, b);
}
PALPATE_LANES Floats low_halves(Floats a, Floats b) noexcept {
  return _mm512_maskz_shuffle_ps(0xffff, a, b, 0x44);
}
PALPATE_LANES Floats high_halves(Floats a, Floats b) noexcept {
  return _mm512_maskz_shuffle_ps(0xffff, a, b, 0xee);
}
#elif defined(__AVX2__)
PALPATE_LANES Floats fours(const float* const (&from)[2]) noexcept {
  return __builtin_shufflevector(four(from[0]), four(from[1]), 0, 1, 2, 3, 4, 5, 6, 7);
}
PALPATE_LANES Floats low_mixed(Floats a, Floats b) noexcept { return _mm256_unpacklo_ps(a, b); }
PALPATE_LANES Floats high_mixed(Floats a, Floats b) noexcept { return _mm256_unpackhi_ps(a, b); }
PALPATE_LANES Floats low_halves(Floats a, Floats b) noexcept {
  return _mm256_shuffle_ps(a, b, 0x44);
}
PALPATE_LANES Floats high_halves(Floats a, Floats b) noexcept {
  return _mm256_shuffle_ps(a, b, 0xee);
}
#else
PALPATE_LANES Floats fours(const float* const (&from)[1]) noexcept { return four(from[0]); }
PALPATE_LANES Floats low_mixed(Floats a, Floats b) noexcept {
  return __builtin_shufflevector(a, b, 0, 4, 1, 5);
}
PALPATE_LANES Floats high_mixed(Floats a, Floats b) noexcept {
  return __builtin_shufflevector(a, b, 2, 6, 3, 7);
}
PALPATE_LANES Floats low_halves(Floats a, Floats b) noexcept {
  return __builtin_shufflevector(a, b, 0, 1, 4, 5);
}
PALPATE_LANES Floats high_halves(Floats a, Floats b) noexcept {
  return __builtin_shufflevector(a, b, 2, 3, 6, 7);
}
#endif

/// 1 where the mask is set.
PALPATE_LANES Ints ones(Ints mask) noexcept { return -mask; }

/// Bit i set where lane i of the mask is.
PALPATE_LANES std::uint32_t bits(Ints mask) noexcept {
#if defined(__AVX512F__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
  std::uint32_t out = 0;
  for (int i = 0; i < kLanes; ++i) out |= (static_cast<std::uint32_t>(mask[i]) >> 31) << i;
  return out;
#endif
}

#else

inline constexpr int kLanes = 1;

using Floats = float;
using Ints = int;  ///< 0 or not

PALPATE_LANES Floats load(const float* from) noexcept { return *from; }
PALPATE_LANES void store(Floats v, float* to) noexcept { *to = v; }
PALPATE_LANES Ints load(const std::int32_t* from) noexcept { return *from; }
PALPATE_LANES void store(Ints v, std::int32_t* to) noexcept { *to = v; }
PALPATE_LANES Floats all(float v) noexcept { return v; }
PALPATE_LANES Ints all(std::int32_t v) noexcept { return v; }
PALPATE_LANES Ints counting() noexcept { return 0; }
PALPATE_LANES Floats magnitude(Floats v) noexcept { return __builtin_fabsf(v); }
PALPATE_LANES Ints truncated(Floats v) noexcept { return static_cast<Ints>(v); }
PALPATE_LANES Ints ones(Ints mask) noexcept { return mask != 0 ? 1 : 0; }
PALPATE_LANES std::uint32_t bits(Ints mask) noexcept { return mask != 0 ? 1 : 0; }

#endif

PALPATE_LANES Ints as_bits(Floats v) noexcept { return std::bit_cast<Ints>(v); }

/// Second operand where the comparison is false, NaN included: what x86 has an instruction for.
#if PALPATE_VECTORS && defined(__AVX512F__)
// Masked, with all lanes: without a mask the header of GCC 12 warns of itself.
PALPATE_LANES Floats least(Floats a, Floats b) noexcept {
  return _mm512_maskz_min_ps(0xffff, a, b);
}
PALPATE_LANES Floats most(Floats a, Floats b) noexcept { return _mm512_maskz_max_ps(0xffff, a, b); }
#elif PALPATE_VECTORS && defined(__AVX2__)
PALPATE_LANES Floats least(Floats a, Floats b) noexcept { return _mm256_min_ps(a, b); }
PALPATE_LANES Floats most(Floats a, Floats b) noexcept { return _mm256_max_ps(a, b); }
#elif PALPATE_VECTORS && defined(__SSE2__)
PALPATE_LANES Floats least(Floats a, Floats b) noexcept { return _mm_min_ps(a, b); }
PALPATE_LANES Floats most(Floats a, Floats b) noexcept { return _mm_max_ps(a, b); }
#else
PALPATE_LANES Floats least(Floats a, Floats b) noexcept { return a < b ? a : b; }
PALPATE_LANES Floats most(Floats a, Floats b) noexcept { return a > b ? a : b; }
#endif
PALPATE_LANES Floats clamp01(Floats v) noexcept { return least(most(v, Floats{}), all(1.0f)); }

/// Three-vectors, lane by lane.
struct Vectors {
  Floats x, y, z;
};
PALPATE_LANES Vectors operator+(Vectors a, Vectors b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
PALPATE_LANES Vectors operator-(Vectors a, Vectors b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
PALPATE_LANES Vectors operator*(Floats s, Vectors a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
PALPATE_LANES Floats dot(Vectors a, Vectors b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
PALPATE_LANES Vectors cross(Vectors a, Vectors b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
PALPATE_LANES Vectors select(Ints mask, Vectors a, Vectors b) noexcept {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace
}  // namespace palpate::regions
