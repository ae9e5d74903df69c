// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/pairing.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace palpate::bake {
namespace {

constexpr std::size_t kAllPairsBelow =
    200;  // about where all pairs cost what the neighbours of 20,000 pieces cost
constexpr std::size_t kMortonWindow = 8;  // successors on the curve that a piece is tried with

// Pieces a pair that has to be found: 64 levels are then enough for 2^24 pieces. The curve joins
// all pieces to one path, which makes so many pairs possible.
constexpr std::size_t kLeastProgress = 4;

// The bits of a 21-bit number, two apart.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

// Of the centre of the bounds; the object lies in the unit ball.
std::uint64_t morton_code(const Dop& dop) {
  std::uint64_t code = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = (dop.low[axis] + dop.high[axis]) / 2;
    const double cell = std::clamp((centre + 1) / 2, 0.0, 1.0) * 0x1fffff;
    code |= spread(static_cast<std::uint64_t>(cell)) << axis;
  }
  return code;
}

void add_morton_neighbours(std::span<const Dop> pieces, std::vector<PiecePair>& out) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> curve(pieces.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i) curve[i] = {morton_code(pieces[i]), i};
  std::sort(curve.begin(), curve.end());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(curve.size(), i + 1 + kMortonWindow); ++j) {
      out.push_back(std::minmax(curve[i].second, curve[j].second));
    }
  }
}

std::vector<PiecePair> candidates(std::span<const Dop> pieces,
                                  std::span<const PiecePair> neighbours) {
  std::vector<PiecePair> pairs;
  if (pieces.size() < kAllPairsBelow) {
    for (std::uint32_t a = 0; a < pieces.size(); ++a) {
      for (std::uint32_t b = a + 1; b < pieces.size(); ++b) pairs.emplace_back(a, b);
    }
    return pairs;
  }
  pairs.assign(neighbours.begin(), neighbours.end());
  add_morton_neighbours(pieces, pairs);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

struct Candidate {
  double cost;
  PiecePair pair;
  bool tight;
  bool operator<(const Candidate& o) const {
    return std::tie(cost, pair) < std::tie(o.cost, o.pair);
  }
};

// The mean width of the hull of two convex sets that meet is at most the sum of theirs.
Candidate candidate(const PiecePair& pair, std::span<const Dop> pieces) {
  const Dop &a = pieces[pair.first], &b = pieces[pair.second];
  const double merged = mean_width(united(a, b)), sum = mean_width(a) + mean_width(b);
  return {merged - sum / 2, pair, merged <= sum};
}

// Takes candidates in their order while both partners are free and fewer than `enough` pairs are
// made.
void match(const std::vector<Candidate>& queue, bool tight_only, std::size_t enough,
           std::vector<char>& taken, std::vector<PiecePair>& matched) {
  for (const auto& [cost, pair, tight] : queue) {
    if (matched.size() >= enough) return;
    if (taken[pair.first] || taken[pair.second] || (tight_only && !tight)) continue;
    taken[pair.first] = taken[pair.second] = 1;
    matched.push_back(pair);
  }
}

}  // namespace

std::vector<PiecePair> pair_up(std::span<const Dop> pieces, std::span<const PiecePair> neighbours) {
  const std::vector<PiecePair> pairs = candidates(pieces, neighbours);
  std::vector<Candidate> queue(pairs.size());
  std::transform(pairs.begin(), pairs.end(), queue.begin(),
                 [&](const PiecePair& pair) { return candidate(pair, pieces); });
  std::sort(queue.begin(), queue.end());
  std::vector<char> taken(pieces.size(), 0);
  std::vector<PiecePair> matched;
  match(queue, true, pieces.size(), taken, matched);
  match(queue, false, (pieces.size() + kLeastProgress - 1) / kLeastProgress, taken, matched);
  std::sort(matched.begin(), matched.end());
  return matched;
}

}  // namespace palpate::bake
