// SPDX-License-Identifier: Apache-2.0
// An engine's memory as bytes: saved, moved, and continued elsewhere.
//
// To save, copy the first required_bytes() of the memory that create() was given, between ticks.
// To continue, bring the copy to any 64-byte boundary of memory of the same size and restore() it.
// Ticks after that give the same bits as those of the engine that was copied, which may go on too.
// The copy is for the same build of the engine on the same kind of machine: it is not a file
// format.
#pragma once

#include <cstddef>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate {

/// Makes an engine of a copy of another one's memory.
///
/// @param scene   the same bodies (equal images, at any address), pairs and tool; outlives the
/// engine
/// @param limits  those that the engine was made with
/// @param kind    its settings' engine
/// @param memory  the copy, 64-byte aligned; the bytes are trusted beyond what the errors say
/// Errors: bad_argument (scene, limits or kind are out of range or not those of the copy, or the
/// bytes are of no engine), not_enough_memory. Nothing is written where it fails. O(bodies +
/// pairs).
Status restore(const Scene& scene, const Limits& limits, EngineKind kind,
               std::span<std::byte> memory, Engine*& out_engine) noexcept;

}  // namespace palpate
