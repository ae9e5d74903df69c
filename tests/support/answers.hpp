// SPDX-License-Identifier: GPL-3.0-or-later
// What has to hold of one tick's answer, and what two answers are compared by.
#pragma once

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "tests/support/baked_scene.hpp"

namespace palpate::test {

/// The certificate holds: no contact is lost beyond what it says.
inline void expect_certified(const TickResult& r, double truth, double delta) {
  const double bound = r.certificate.error_bound_m;
  ASSERT_TRUE(std::isfinite(bound));
  if (r.contacts.empty()) {
    EXPECT_GE(truth + bound, 0.9999 * delta) << "a contact was lost";
    EXPECT_FALSE(truth < 0.9999 * delta && r.certificate.contact == ContactStatus::ruled_out);
  } else if (truth > 0) {
    EXPECT_LE(std::abs(r.min_distance_m - truth), bound + 2e-6);
  }
}

using PieceNumbers = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Which pieces are in contact.
inline PieceNumbers pairs_of(const TickResult& r) {
  PieceNumbers pairs;
  for (const Contact& c : r.contacts) pairs.emplace(c.piece_a, c.piece_b);
  return pairs;
}

}  // namespace palpate::test
