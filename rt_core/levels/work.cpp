// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/work.hpp"

namespace palpate::levels {

bool Work::only_culls(const Node& node) const noexcept {
  const PairState& pair = pair_of(node);
  return (rules.exact && !may_end) || is_free(piece_a(pair, node)) || is_free(piece_b(pair, node));
}

bool Work::proves_far(Node& node) noexcept {
  const PairState& pair = pair_of(node);
  if (!only_culls(node)) return proves_far(node, probe.own(pair, node));
  static_cast<void>(probe.cull(pair, node, Ask::nearness));
  set_lower_bound(pair, node, certified_now(pair, node));
  return !is_near(node);
}

bool Work::proves_far(Node& node, const convex::Distance& own) noexcept {
  const PairState& pair = pair_of(node);
  if (own.lower_bound >= pair.delta && certified_now(pair, node) < pair.delta &&
      probe.has_tighter(pair, node) && !out_of_budget()) {
    static_cast<void>(probe.cull(pair, node));
  }
  const double certified = certified_now(pair, node);
  const bool own_counts = own.lower_bound < certified && !rules.exact;
  set_lower_bound(pair, node, own_counts ? own.lower_bound : certified);
  return !is_near(node);
}

void Work::wait(Waiting item) noexcept {
  item.keeps = tree[item.node].contact == kFound;
  waiting.push(item);
  kept += item.keeps ? 1u : 0u;
  leave_time_for_contacts();
  tally.count([&](auto& counters) { raise_mark(counters.most_waiting, waiting.items().size()); });
}

std::uint32_t Work::next() noexcept {
  const Waiting item = waiting.top();
  waiting.pop();
  kept -= item.keeps ? 1u : 0u;
  return item.node;
}

void Work::leave_unresolved(double lower_m, const Node& node) noexcept {
  if (lower_m < result.unresolved_lower_m) result.unresolved_lower_m = lower_m;
  const PairState& pair = pair_of(node);
  const image::Piece& a = piece_a(pair, node);
  const image::Piece& b = piece_b(pair, node);
  const float size = a.radius > b.radius ? a.radius : b.radius;
  const float missing = node.s_star < size ? node.s_star : size;  // free levels have no metric
  if (static_cast<double>(missing) > result.s_worst) result.s_worst = static_cast<double>(missing);
}

void Work::leave(std::uint32_t index, double lower_m) noexcept {
  Node& node = tree[index];
  leave_unresolved(lower_m, node);
  if (node.contact == kFound) add_contact(node, remeasured(pair_of(node), node));
}

void Work::leave_doubtful(std::uint32_t index) noexcept {
  Node& node = tree[index];
  const PairState& pair = pair_of(node);
  if (node.contact == kDoubtful && pair.nearest >= pair.delta)
    add_contact(node, remeasured(pair, node));
}

void Work::note_cap(const PairState& pair, const LeafContact& contact) noexcept {
  if (!contact.capped) return;
  result.iteration_cap_met = true;
  const double gap = (contact.distance - contact.lower_bound) * pair.unit_m;
  if (gap > result.capped_gap_m) result.capped_gap_m = gap;
}

void Work::leave_time_for_contacts() noexcept { meter.expect_contacts(report.count() + kept); }

void Work::add_contact(Node& node, const LeafContact& contact) noexcept {
  PairState& pair = pair_of(node);
  if (contact.distance >= pair.delta) return;
  if (contact.distance < pair.nearest) pair.nearest = contact.distance;
  if (report.add(pair, node, contact)) return leave_time_for_contacts();
  result.truncated_by_memory = true;
  leave_unresolved(certified_m(node), node);
}

}  // namespace palpate::levels
