// SPDX-License-Identifier: Apache-2.0
// What is done with time that is left, for later ticks and for the certificate.
#pragma once

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// A parent all of whose children are far takes their place, so that the front does not grow for
/// ever. Looks at a part of the front a tick, in turn, and spends a share of the tick's queries.
void raise(Work& work) noexcept;

/// The least lower bound of a stopped node sets the certificate, and the culling hulls may prove
/// more than h does: they are queried, nearest first, for a share of the tick's queries.
void tighten(Work& work) noexcept;

}  // namespace palpate::levels
