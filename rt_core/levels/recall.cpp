// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/recall.hpp"

#include <limits>

#include "rt_core/levels/leaf_contact.hpp"

namespace palpate::levels {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// One touch is remembered for each part of a that is as large as this, in deltas; parts whose
/// numbers fall on the same place share it.
constexpr double kPart = 1;
/// One unit in so many is spent at most.
constexpr std::uint64_t kShare = 2;

std::span<Touch> touches_of(const Work& work, std::size_t pair) noexcept {
  return work.memory.touches.subspan(pair * kTouches, kTouches);
}

/// The smallest piece that holds a piece and is a part.
std::uint32_t part_of(const PairState& pair, std::uint32_t piece) noexcept {
  for (std::uint32_t level = 0; level <= image::kMaxLevels; ++level) {
    const image::Piece& at = pair.image_a->pieces[piece];
    const bool large = pair.scale_a * static_cast<double>(at.radius) >= kPart * pair.delta;
    if (large || at.parent == kNone) break;
    piece = at.parent;
  }
  return piece;
}

/// A piece and all that hold it, up to the root.
class Path {
 public:
  Path(const ImageView& image, std::uint32_t piece) noexcept {
    for (; piece != kNone && length_ <= image::kMaxLevels; piece = image.pieces[piece].parent)
      pieces_[length_++] = piece;
    at_ = length_ - 1;
  }
  [[nodiscard]] bool is_at(std::uint32_t piece) const noexcept { return pieces_[at_] == piece; }
  [[nodiscard]] bool leads_to(std::uint32_t piece) const noexcept {
    return at_ > 0 && pieces_[at_ - 1] == piece;
  }
  void descend() noexcept { --at_; }

 private:
  std::uint32_t pieces_[image::kMaxLevels + 1];
  std::uint32_t length_ = 0;
  std::uint32_t at_ = 0;  ///< from the root down
};

/// The front node that holds a pair of pieces; kNone where the front is finer.
std::uint32_t holder_of(const TestTree& tree, const PairState& pair, const Touch& touch) noexcept {
  Path a(*pair.image_a, touch.a);
  Path b(*pair.image_b, touch.b);
  std::uint32_t node = pair.root;
  while (node != kNone && !tree.in_front(node)) {
    node = tree[node].first_child;
    for (; node != kNone; node = tree[node].next_sibling) {
      const Node& child = tree[node];
      if (a.is_at(child.piece_a) && b.leads_to(child.piece_b)) {
        b.descend();
        break;
      }
      if (b.is_at(child.piece_b) && a.leads_to(child.piece_a)) {
        a.descend();
        break;
      }
    }
  }
  return node;
}

bool keeps_contact(const Work& work, std::size_t pair) noexcept {
  for (const std::uint32_t index : work.tree.front()) {
    const Node& node = work.tree[index];
    if (node.pair != pair || node.contact != kFound || !work.is_near(node)) continue;
    if (remeasured(work.pair_of(node), node).distance < work.pair_of(node).delta) return true;
  }
  return false;
}

/// Of the points that touched, as the bodies stand now.
double apart(const PairState& pair, const Touch& touch) noexcept {
  const Vec3d point_b =
      pair.b_in_a.rotation * vec_cast<double>(touch.point_b) + pair.b_in_a.translation;
  return norm(vec_cast<double>(touch.point_a) - point_b);
}

/// As far as their spheres tell.
bool is_near(const PairState& pair, const Touch& touch) noexcept {
  return sphere_distance(pair, pair.image_a->pieces[touch.a], pair.image_b->pieces[touch.b]) <
         pair.delta;
}

/// What two pieces give now. One query, which starts from what the last one found, and those of
/// open patches.
LeafContact touch_again(Work& work, Touch& touch, const Node& holder) noexcept {
  const PairState& pair = work.pair_of(holder);
  Node node;
  node.pair = holder.pair;
  node.piece_a = touch.a;
  node.piece_b = touch.b;
  node.normal = touch.normal;
  node.own = touch.own;
  begin(pair, node, -kInfinity);
  const image::Piece& a = piece_a(pair, node);
  const image::Piece& b = piece_b(pair, node);
  const convex::Distance d = work.probe.own(pair, node);
  touch.own = node.own;
  if (!convex::overlaps(d)) touch.normal = vec_cast<float>(d.normal);
  const bool simplified = is_simplified(a) || is_simplified(b);
  if (d.lower_bound >= pair.delta || (simplified && convex::overlaps(d))) return {};
  const LeafContact contact = leaf_contact(pair, a, b, d, node.own, pair.delta,
                                           work.meter.queries_left(), *work.memory.scratch);
  work.probe.charge_parts(contact.queries);
  return contact;
}

/// @return whether the front node that holds the pieces keeps a contact
bool keep_if_touching(Work& work, Touch& touch, const PairState& pair) noexcept {
  const std::uint32_t index = holder_of(work.tree, pair, touch);
  if (index == kNone || !work.is_near(work.tree[index])) return false;
  Node& node = work.tree[index];
  const LeafContact contact = touch_again(work, touch, node);
  if (!contact.found || contact.distance >= pair.delta) return false;
  if (node.contact == kFound && remeasured(pair, node).distance <= contact.distance) return true;
  keep(pair, pair.image_a->pieces[touch.a], pair.image_b->pieces[touch.b], contact, node);
  node.leaf_a = touch.a;
  node.leaf_b = touch.b;
  return true;
}

}  // namespace

void remember(Work& work, const Node& node) noexcept {
  if (!remembers(work)) return;
  constexpr std::uint32_t kGolden = 0x9e3779b1u;  // spreads numbers that follow each other
  const std::uint32_t part = part_of(work.pair_of(node), node.piece_a);
  touches_of(work, node.pair)[(part * kGolden) >> (32 - kTouchBits)] = {
      node.piece_a, node.piece_b, node.witness_a, node.witness_b, node.normal, node.own};
}

bool recall(Work& work, std::size_t index, bool enough) noexcept {
  const PairState& pair = work.memory.pairs[index];
  const std::span<Touch> known = touches_of(work, index);
  bool touches = keeps_contact(work, index);
  if (touches && enough) return true;
  double reach = kInfinity;
  if (touches) reach = pair.delta;
  const std::size_t most = work.memory.waiting.size();
  for (std::uint32_t i = 0; i < kTouches && work.waiting.items().size() < most; ++i) {
    if (known[i].a == kNone) continue;
    const double now = apart(pair, known[i]);
    if (now < reach && is_near(pair, known[i])) work.waiting.push({now, now, i, false});
  }
  const std::uint64_t share = work.meter.queries_left() / kShare;
  const std::uint64_t end = work.probe.queries() + (share < kMostRecalled ? share : kMostRecalled);
  while (!work.waiting.empty() && work.probe.queries() < end && !work.out_of_budget()) {
    Touch& touch = known[work.waiting.top().node];
    work.waiting.pop();
    if (keep_if_touching(work, touch, pair)) touches = true;
  }
  work.waiting.clear();
  return touches;
}

}  // namespace palpate::levels
