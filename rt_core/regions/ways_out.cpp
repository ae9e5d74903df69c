// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/ways_out.hpp"

#include "rt_core/base/queue.hpp"

namespace palpate::regions {
namespace {

/// By pieces, the shortest way first.
struct ByPieces {
  std::span<const Contact> contacts;

  [[nodiscard]] bool same(const WayOut& x, const WayOut& y) const noexcept {
    return pair(x) == pair(y) && x.piece_a == y.piece_a && x.piece_b == y.piece_b;
  }
  bool operator()(const WayOut& x, const WayOut& y) const noexcept {
    if (pair(x) != pair(y)) return pair(x) < pair(y);
    if (x.piece_a != y.piece_a) return x.piece_a < y.piece_a;
    if (x.piece_b != y.piece_b) return x.piece_b < y.piece_b;
    if (x.length < y.length || y.length < x.length) return x.length < y.length;
    return x.contact < y.contact;
  }
  [[nodiscard]] std::uint32_t pair(const WayOut& way) const noexcept {
    return contacts[way.contact].pair;
  }
};

/// The shortest ways of two pieces, in order.
struct Shortest {
  static constexpr std::uint32_t kMost = 16;  ///< others are left out
  WayOut ways[kMost];
  std::uint32_t count = 0;

  void add(const WayOut& way) noexcept {
    if (count < kMost) ways[count++] = way;
  }
};

/// Of a way, how much is felt beside those that are shorter.
double felt_of(const WayOut& way, const Shortest& shorter,
               std::span<const Contact> contacts) noexcept {
  const double shortest = shorter.ways[0].length;
  double felt = shortest / way.length;
  for (std::uint32_t i = 0; i < shorter.count; ++i) {
    const WayOut& other = shorter.ways[i];
    const double cosine = dot(contacts[way.contact].normal, contacts[other.contact].normal);
    const double by_other = shortest / other.length * cosine;
    felt = by_other > felt ? by_other : felt;
  }
  return felt < 1 ? felt : 1;  // a normal's cosine with itself may be more by rounding
}

}  // namespace

void share_by_ways_out(std::span<WayOut> ways, std::span<Contact> contacts) noexcept {
  if (ways.empty()) return;
  const ByPieces by_pieces{contacts};
  MinQueue<WayOut, ByPieces> queue(ways, by_pieces);
  queue.fill();
  Shortest shorter;
  for (; !queue.empty(); queue.pop()) {
    const WayOut next = queue.top();
    if (shorter.count > 0 && !by_pieces.same(next, shorter.ways[0])) shorter.count = 0;
    shorter.add(next);
    contacts[next.contact].share -= next.part * (1 - felt_of(next, shorter, contacts));
  }
}

}  // namespace palpate::regions
