// SPDX-License-Identifier: Apache-2.0
// What stands at the beginning of an engine's memory.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/tally.hpp"
#include "rt_core/force/places.hpp"
#include "rt_core/force/wrench.hpp"
#include "rt_core/levels/levels_engine.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/contact_search.hpp"
#include "rt_core/regions/minima.hpp"

namespace palpate {

class Engine {
 public:
  std::span<const BodyPair> pairs;
  std::uint64_t made_for = 0;  // scene and limits: what a copy of the memory is good for
  std::uint32_t bodies = 0;
  std::uint32_t tool = 0;
  Settings settings;
  std::span<Pose> poses;                // of this tick, normalised
  std::span<levels::PairState> states;  // [pairs]
  levels::QueryMemory levels;           // of the engine's kind; the other is empty
  regions::ContactMemory search;
  regions::MinimaMemory minima;
  std::span<Contact> contacts;
  std::span<force::PushPoint> push_points;  // [contacts], as search.constraints
  force::Places places;
  bool overlapping = false;           // bodies of the levels engine did, in the last tick
  TailTime tail;                      // of the ticks so far
  [[no_unique_address]] Tally tally;  // last: its size is a switch of the build
};

}  // namespace palpate
