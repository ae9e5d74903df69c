// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/kernels.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace palpate::regions {
namespace {

struct Processor {
  bool avx2 = false;
  bool avx512 = false;
};

#if defined(__x86_64__)

/// Which registers the operating system saves: bits 1 and 2 for AVX, 5 to 7 for AVX-512 (Intel SDM
/// vol. 1, 13.3 and 15.2).
std::uint32_t saved_registers() noexcept {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

Processor ask() noexcept {
  constexpr std::uint32_t kSavesAvx = 0x06;
  constexpr std::uint32_t kSavesAvx512 = 0xe6;
  Processor found;
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_OSXSAVE) == 0) return found;
  const std::uint32_t saved = saved_registers();
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0) return found;
  found.avx2 = (saved & kSavesAvx) == kSavesAvx && (b & bit_AVX2) != 0;
  found.avx512 =
      (saved & kSavesAvx512) == kSavesAvx512 && (b & bit_AVX512F) != 0 && (b & bit_AVX512DQ) != 0;
  return found;
}

#else

Processor ask() noexcept { return {}; }

#endif

}  // namespace

std::uint32_t all_kernels(const Kernels* (&out)[kMostKernels]) noexcept {
  const Processor processor = ask();
  std::uint32_t count = 0;
  const auto add = [&](bool runs, const Kernels* table) {
    if (runs && table != nullptr) out[count++] = table;
  };
  add(true, kernels_scalar());
  add(true, kernels_base());
  add(processor.avx2, kernels_avx2());
  add(processor.avx512, kernels_avx512());
  return count;
}

const Kernels& best_kernels() noexcept {
  const Kernels* found[kMostKernels] = {};
  return *found[all_kernels(found) - 1];
}

}  // namespace palpate::regions
