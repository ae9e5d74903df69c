// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/ways_out.hpp"

#include "rt_core/base/queue.hpp"

namespace palpate::regions {
namespace {

bool of_same_pieces(const Contact& x, const Contact& y) noexcept {
  return x.pair == y.pair && x.piece_a == y.piece_a && x.piece_b == y.piece_b;
}

/// By pieces, the shortest way first.
struct ByPieces {
  std::span<const Contact> contacts;
  bool operator()(const WayOut& x, const WayOut& y) const noexcept {
    const Contact& cx = contacts[x.contact];
    const Contact& cy = contacts[y.contact];
    if (cx.pair != cy.pair) return cx.pair < cy.pair;
    if (cx.piece_a != cy.piece_a) return cx.piece_a < cy.piece_a;
    if (cx.piece_b != cy.piece_b) return cx.piece_b < cy.piece_b;
    if (x.length < y.length || y.length < x.length) return x.length < y.length;
    return x.contact < y.contact;
  }
};

}  // namespace

void share_by_ways_out(std::span<WayOut> ways, std::span<Contact> contacts) noexcept {
  if (ways.empty()) return;
  MinQueue<WayOut, ByPieces> queue(ways, ByPieces{contacts});
  queue.fill();
  WayOut shortest = queue.top();
  for (; !queue.empty(); queue.pop()) {
    const WayOut next = queue.top();
    Contact& contact = contacts[next.contact];
    if (!of_same_pieces(contact, contacts[shortest.contact])) shortest = next;
    if (next.length > shortest.length) contact.share *= shortest.length / next.length;
  }
}

}  // namespace palpate::regions
