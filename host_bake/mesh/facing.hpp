// SPDX-License-Identifier: GPL-3.0-or-later
// Does a surface look outward?
#pragma once

#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {

enum class Facing : char {
  fine,
  inward,    ///< to be turned
  doubtful,  ///< open and hollow towards its front: the inside of a bowl, or a surface inside out
};

/// The facing of each component. Precondition: every component is a consistently oriented
/// 2-manifold, points finite.
///
/// A closed component that lies in an even number of others (in none, mostly) has to enclose a
/// positive volume; within an odd number a negative one is a cavity and a positive one a body of
/// its own. Components inside one that is turned are turned with it, so that an inside-out shell
/// keeps its cavity. "Lies in" is decided for the first vertex, exactly: a vertical ray counts the
/// faces above it, with half-open edges so that none counts twice.
///
/// For an open component the volume is that of the cone from its centroid. It is inward where that
/// is clearly negative and the component all but closed (the vector sum of its face areas is below
/// a tenth of their sum), doubtful where it is more open.
///
/// O(n), and O(components * log n) more where a closed component has a negative volume.
std::vector<Facing> facing_of(const Mesh& mesh, const Components& components);

}  // namespace palpate::bake
