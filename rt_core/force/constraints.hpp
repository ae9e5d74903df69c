// SPDX-License-Identifier: Apache-2.0
// Contacts as constraints of the least push.
#pragma once

#include <span>

#include "rt_core/force/least_push.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::force {

/// What a contact that has faded out is short of zero, as a share of the strongest: "at least zero"
/// is a constraint too (docs/CONTACT.md).
inline constexpr double kFadedShare = 0.5;

/// Sets the constraint of each contact: the direction in which it pushes the tool, and its strength
/// share * (delta - distance) - (1 - share) * strongest / 2. Contacts of pairs without the tool get
/// a strength below any push.
/// @return the strongest share * (delta - distance), >= 0; metres. O(contacts)
double set_constraints(std::span<const Contact> contacts, std::span<const BodyPair> pairs,
                       std::uint32_t tool, double delta_m, std::span<PushConstraint> out) noexcept;

}  // namespace palpate::force
