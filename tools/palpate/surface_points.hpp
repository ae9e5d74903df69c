// SPDX-License-Identifier: GPL-3.0-or-later
// Points of contacts on the surfaces of overlapping bodies.
#pragma once

#include <span>
#include <vector>

#include "rt_core/palpate_rt.hpp"

namespace palpate::cli {

/// Where pieces overlap an engine gives points about the overlap, between which its force acts. A
/// table of contacts gives points of the surfaces instead: those of the two pieces' patches that
/// are nearest to them.
class SurfacePoints {
 public:
  /// @param bodies, pairs  of the scene; must outlive this
  SurfacePoints(std::span<const ImageView> bodies, std::span<const BodyPair> pairs)
      : bodies_(bodies), pairs_(pairs) {}

  /// @param contacts  of a tick, as the engine gave them
  /// @param poses     [bodies] of that tick
  /// @return the contacts, valid until the next call; those apart, and of pieces without a patch
  ///         (free levels), as they were
  std::span<const Contact> of(std::span<const Contact> contacts, std::span<const Pose> poses);

 private:
  std::span<const ImageView> bodies_;
  std::span<const BodyPair> pairs_;
  std::vector<Contact> contacts_;
};

}  // namespace palpate::cli
