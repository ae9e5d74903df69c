// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/upkeep.hpp"

namespace palpate::levels {
namespace {

/// Raising looks at this many front nodes a tick, plus this share of them, and spends at most so
/// many queries; tightening likewise.
constexpr std::uint32_t kRaiseScan = 64;
constexpr std::uint32_t kRaiseScanShare = 32;
constexpr std::uint64_t kSpareQueries = 16;
constexpr std::uint64_t kSpareQueryShare = 8;

std::uint64_t spare_queries(const Work& work) noexcept {
  return work.probe.queries() + kSpareQueries + work.probe.queries() / kSpareQueryShare;
}

bool children_in_front(const TestTree& tree, const Node& parent) noexcept {
  for (std::uint32_t c = parent.first_child; c != kNone; c = tree[c].next_sibling) {
    if (!tree.in_front(c)) return false;
  }
  return true;
}

bool children_far(const Work& work, const Node& parent) noexcept {
  const TestTree& tree = work.tree;
  for (std::uint32_t c = parent.first_child; c != kNone; c = tree[c].next_sibling) {
    if (work.is_near(tree[c])) return false;
  }
  return true;
}

/// Puts a parent in the place of its children where it gives no contact, nor does anything below
/// it.
void raise_far(Work& work, std::uint32_t parent) noexcept {
  Node& node = work.tree[parent];
  if (!children_far(work, node) || (work.is_near(node) && !work.proves_far(node))) return;
  work.tree.collapse(parent);
  node.contact = 0;
  clear(node, kOfThisTick);
}

}  // namespace

void raise(Work& work) noexcept {
  TestTree& tree = work.tree;
  const std::uint64_t end = spare_queries(work);
  const std::size_t scan = kRaiseScan + tree.front().size() / kRaiseScanShare;
  std::size_t& next = work.memory.raise_next;
  for (std::size_t i = 0; i < scan && work.probe.queries() < end; ++i) {
    if (work.out_of_budget()) return;
    if (next >= tree.front().size()) next = 0;
    const std::uint32_t parent = tree[tree.front()[next++]].parent;
    if (parent == kNone) continue;
    if (children_in_front(tree, tree[parent])) raise_far(work, parent);
  }
}

void tighten(Work& work) noexcept {
  if (work.rules.exact || work.rules.bounds == Bounds::paper) return;
  for (const std::uint32_t index : work.stopped.all()) {
    const Node& node = work.tree[index];
    if (!work.probe.has_tighter(work.pair_of(node), node)) continue;
    const double certified_m = work.certified_m(node);
    work.waiting.push({certified_m, certified_m, index, false});
  }
  const std::uint64_t end = spare_queries(work);
  while (!work.waiting.empty() && work.probe.queries() < end && !work.out_of_budget()) {
    Node& node = work.tree[work.waiting.top().node];
    work.waiting.pop();
    static_cast<void>(work.probe.cull(work.pair_of(node), node));
  }
  work.waiting.clear();
}

}  // namespace palpate::levels
