// SPDX-License-Identifier: Apache-2.0
// What goes wrong between a device and a host, by script and in virtual time: the same script and
// seed give the same faults.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace palpate::hal::mock {

enum class FaultKind : std::uint8_t {
  drop,      ///< does not arrive
  delay,     ///< arrives `amount` seconds later
  repeat,    ///< arrives twice
  reorder,   ///< arrives after the next one
  truncate,  ///< arrives without its last `amount` bytes
  corrupt,   ///< arrives with `amount` bytes changed
  unplug,    ///< nothing is connected; the end of the window plugs it in again
  nan,       ///< the pose is not a number
  stuck,     ///< the encoders stand still
  drift      ///< the device's clock runs (1 + `amount`) times as fast
};

/// A fault that holds for a while.
struct FaultWindow {
  FaultKind kind = FaultKind::drop;
  double from_s = 0;  ///< since the device's time zero
  double for_s = 0;
  double amount = 0;
  double share = 1;  ///< of what passes in the window that is hit, in [0, 1]
};

class Faults {
 public:
  Faults() = default;
  Faults(std::vector<FaultWindow> script, std::uint64_t seed)
      : script_(std::move(script)), random_(seed) {}

  /// The window of a kind that holds at a time and hits now; null where none. Draws a number where
  /// the window's share is not 1.
  [[nodiscard]] const FaultWindow* hit(FaultKind kind, double t_s) noexcept {
    for (const FaultWindow& w : script_) {
      const bool holds = w.kind == kind && t_s >= w.from_s && t_s < w.from_s + w.for_s;
      if (holds && (w.share >= 1 || uniform() < w.share)) return &w;
    }
    return nullptr;
  }

  /// Seconds by which the device's clock is ahead at a time.
  [[nodiscard]] double clock_error_s(double t_s) const noexcept {
    double ahead_s = 0;
    for (const FaultWindow& w : script_) {
      if (w.kind == FaultKind::drift)
        ahead_s += w.amount * std::clamp(t_s - w.from_s, 0.0, w.for_s);
    }
    return ahead_s;
  }

  /// A number in [0, 2^64): SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
  std::uint64_t random() noexcept {
    std::uint64_t z = random_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }

 private:
  double uniform() noexcept { return static_cast<double>(random() >> 11) * 0x1p-53; }

  std::vector<FaultWindow> script_;
  std::uint64_t random_ = 0;
};

/// Carries values from one end to the other, with the faults that need no look inside them: drop,
/// delay, repeat, reorder.
template <class T>
class FaultyLine {
 public:
  /// @param t_s  of the faults' script  @param now_ns  of pop()
  void push(const T& value, double t_s, std::uint64_t now_ns, Faults& faults) {
    if (faults.hit(FaultKind::drop, t_s) != nullptr) return;
    std::uint64_t due_ns = now_ns;
    if (const FaultWindow* w = faults.hit(FaultKind::delay, t_s)) {
      due_ns += static_cast<std::uint64_t>(1e9 * w->amount);
    }
    if (!kept_ && faults.hit(FaultKind::reorder, t_s) != nullptr) {
      kept_ = value;
      return;
    }
    waiting_.push_back({due_ns, value});
    if (faults.hit(FaultKind::repeat, t_s) != nullptr) waiting_.push_back({due_ns, value});
    if (kept_) waiting_.push_back({due_ns, *std::exchange(kept_, std::nullopt)});
  }

  /// What arrives next; absent where nothing is due yet. Values that are due at the same time keep
  /// their order; a delayed one is overtaken.
  [[nodiscard]] std::optional<T> pop(std::uint64_t now_ns) {
    const auto first = std::min_element(waiting_.begin(), waiting_.end(), is_sooner);
    if (first == waiting_.end() || first->due_ns > now_ns) return std::nullopt;
    const T value = first->value;
    waiting_.erase(first);
    return value;
  }

  /// When the next value is due; the largest number where none waits.
  [[nodiscard]] std::uint64_t next_ns() const noexcept {
    const auto first = std::min_element(waiting_.begin(), waiting_.end(), is_sooner);
    return first == waiting_.end() ? ~std::uint64_t{0} : first->due_ns;
  }

  void clear() noexcept {
    waiting_.clear();
    kept_.reset();
  }

 private:
  struct Waiting {
    std::uint64_t due_ns;
    T value;
  };
  static bool is_sooner(const Waiting& a, const Waiting& b) noexcept { return a.due_ns < b.due_ns; }

  std::vector<Waiting> waiting_;
  std::optional<T> kept_;
};

}  // namespace palpate::hal::mock
