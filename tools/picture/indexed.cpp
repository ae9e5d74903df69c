// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/indexed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace palpate::picture {
namespace {

constexpr std::array kChannels = {&Rgb::r, &Rgb::g, &Rgb::b};

std::uint32_t key(Rgb c) {
  return (std::uint32_t{c.r} << 16) | (std::uint32_t{c.g} << 8) | std::uint32_t{c.b};
}

Rgb colour_from(std::uint32_t key) {
  return {static_cast<std::uint8_t>(key >> 16), static_cast<std::uint8_t>(key >> 8),
          static_cast<std::uint8_t>(key)};
}

struct Counted {
  Rgb colour;
  double pixels = 0;
};

std::vector<Counted> count_colours(const std::vector<Rgb>& colours) {
  std::vector<std::uint32_t> keys(colours.size());
  std::transform(colours.begin(), colours.end(), keys.begin(), key);
  std::sort(keys.begin(), keys.end());
  std::vector<Counted> counted;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i] != keys[i - 1]) counted.push_back({colour_from(keys[i])});
    counted.back().pixels += 1;
  }
  return counted;
}

// Colours that become one, and where to split them if they do not.
struct Set {
  explicit Set(std::span<Counted> members_) : members(members_) {
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      double pixels = 0, sum = 0, squares = 0;
      for (const Counted& m : members) {
        const double value = m.colour.*kChannels[c];
        pixels += m.pixels;
        sum += m.pixels * value;
        squares += m.pixels * value * value;
      }
      mean[c] = sum / pixels;
      // Whole numbers far below 2^53 up to the quotient: zero for a single colour.
      const double own = (pixels * squares - sum * sum) / pixels;
      if (own > deviation) {
        deviation = own;
        channel = c;
      }
    }
  }

  [[nodiscard]] Rgb colour() const {
    const auto rounded = [this](std::size_t c) {
      return static_cast<std::uint8_t>(std::lround(mean[c]));
    };
    return {rounded(0), rounded(1), rounded(2)};
  }

  std::span<Counted> members;
  std::array<double, kChannels.size()> mean{};
  double deviation = 0;     // sum of squares over the pixels, in this channel ...
  std::size_t channel = 0;  // ... where it is largest
};

void split_largest(std::vector<Set>& sets) {
  const auto largest = std::max_element(sets.begin(), sets.end(), [](const Set& a, const Set& b) {
    return a.deviation < b.deviation;
  });
  const std::span<Counted> members = largest->members;
  const double mean = largest->mean[largest->channel];
  const auto value = kChannels[largest->channel];
  const auto middle = std::partition(members.begin(), members.end(),
                                     [&](const Counted& m) { return m.colour.*value <= mean; });
  const auto lower = static_cast<std::size_t>(middle - members.begin());
  *largest = Set(members.first(lower));
  sets.emplace_back(members.subspan(lower));
}

}  // namespace

Indexed indexed(const Raster& raster) {
  std::vector<Counted> counted = count_colours(raster.colours);
  std::vector<Set> sets = {Set(counted)};
  // A set of two colours can always be split: its deviation is not zero, so each side of the mean
  // holds one.
  const std::size_t wanted = std::min(counted.size(), kMaxPalette);
  while (sets.size() < wanted) split_largest(sets);

  Indexed out;
  std::vector<std::pair<std::uint32_t, std::uint8_t>> index_of;
  for (const Set& set : sets) {
    const auto index = static_cast<std::uint8_t>(out.palette.size());
    for (const Counted& m : set.members) index_of.emplace_back(key(m.colour), index);
    out.palette.push_back(set.colour());
  }
  std::sort(index_of.begin(), index_of.end());
  out.indices.reserve(raster.colours.size());
  for (const Rgb colour : raster.colours) {
    const std::pair<std::uint32_t, std::uint8_t> least = {key(colour), 0};
    out.indices.push_back(std::lower_bound(index_of.begin(), index_of.end(), least)->second);
  }
  return out;
}

}  // namespace palpate::picture
