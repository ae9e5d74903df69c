// SPDX-License-Identifier: Apache-2.0
// All regions' intervals made narrower, where the force may still change most first.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Until every interval is closed, or all together are within work.demand.tolerance_m, or the
/// budget ends. What searches do not keep up with is followed (follow.hpp). Some units are done in
/// every tick, however late it is: one that does not get to search at all would find nothing in the
/// next one either.
void narrow(Work& work) noexcept;

}  // namespace palpate::regions
