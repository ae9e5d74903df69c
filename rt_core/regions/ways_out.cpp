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

/// Of a way, how much is felt beside the shortest.
double felt_of(const WayOut& way, const WayOut& shortest,
               std::span<const Contact> contacts) noexcept {
  const double cosine = dot(contacts[way.contact].normal, contacts[shortest.contact].normal);
  const double ratio = shortest.length / way.length;
  return ratio > cosine ? ratio : cosine;
}

}  // namespace

void share_by_ways_out(std::span<WayOut> ways, std::span<Contact> contacts) noexcept {
  if (ways.empty()) return;
  const ByPieces by_pieces{contacts};
  MinQueue<WayOut, ByPieces> queue(ways, by_pieces);
  queue.fill();
  WayOut shortest = queue.top();
  for (; !queue.empty(); queue.pop()) {
    const WayOut next = queue.top();
    if (!by_pieces.same(next, shortest)) shortest = next;
    contacts[next.contact].share -= next.part * (1 - felt_of(next, shortest, contacts));
  }
}

}  // namespace palpate::regions
