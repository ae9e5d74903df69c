// SPDX-License-Identifier: GPL-3.0-or-later
// A histogram of durations in fixed memory: percentiles of any length of run, without allocation
// and within 1/32 of the value.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace palpate::realtime {

/// Log2-linear buckets: each power of two is divided into kSubBuckets equal parts; values below
/// kSubBuckets have a bucket each. The layout of HdrHistogram (Tene, 2012) with a fixed resolution.
class Histogram {
 public:
  static constexpr std::size_t kSubBuckets = 32;
  static constexpr std::size_t kBuckets = 60 * kSubBuckets;

  /// O(1), no branches on the data but one; 15 kB of memory in all.
  void add(std::uint64_t value_ns) noexcept {
    ++counts_[bucket_of(value_ns)];
    ++total_;
    if (value_ns > max_) max_ = value_ns;
  }

  [[nodiscard]] std::uint64_t total() const noexcept { return total_; }
  [[nodiscard]] std::uint64_t max_ns() const noexcept { return max_; }

  /// The value that a share of all values does not exceed, rounded up to its bucket's end: never
  /// too small, at most 1/32 too large, never above the maximum. 0 where nothing was added. @param
  /// share  in [0, 1]
  [[nodiscard]] std::uint64_t percentile_ns(double share) const noexcept {
    const double wanted = share * static_cast<double>(total_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += counts_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted) {
        const std::uint64_t last = first_value(i + 1) - 1;
        return last < max_ ? last : max_;
      }
    }
    return max_;
  }

  /// How many values lie in [from_ns, to_ns), both rounded down to a bucket's start.
  [[nodiscard]] std::uint64_t count_between(std::uint64_t from_ns,
                                            std::uint64_t to_ns) const noexcept {
    std::uint64_t sum = 0;
    for (std::size_t i = bucket_of(from_ns); i < bucket_of(to_ns); ++i) sum += counts_[i];
    return sum;
  }

 private:
  static constexpr int kSubBits = std::countr_zero(kSubBuckets);

  static constexpr std::size_t bucket_of(std::uint64_t value) noexcept {
    if (value < kSubBuckets) return static_cast<std::size_t>(value);
    const int shift = static_cast<int>(std::bit_width(value)) - 1 - kSubBits;
    return static_cast<std::size_t>(shift) * kSubBuckets + static_cast<std::size_t>(value >> shift);
  }

  /// The least value of a bucket; the end of the last one wraps to 0, one past the largest number.
  static constexpr std::uint64_t first_value(std::size_t bucket) noexcept {
    if (bucket < 2 * kSubBuckets) return bucket;
    const std::size_t shift = bucket / kSubBuckets - 1;
    const std::uint64_t mantissa = kSubBuckets + bucket % kSubBuckets;
    return shift + kSubBits >= 64 ? 0 : mantissa << shift;
  }

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t total_ = 0;
  std::uint64_t max_ = 0;
};

}  // namespace palpate::realtime
