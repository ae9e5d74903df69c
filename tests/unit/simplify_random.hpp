// SPDX-License-Identifier: GPL-3.0-or-later
// Small awkward meshes.
#pragma once

#include <cstdint>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::test {

/// One of: noisy, slivered, partly coplanar, needled, touching components, open boundaries; by
/// seed. 50 to 1,000 faces; repaired.
bake::Mesh awkward_mesh(std::uint32_t seed);

}  // namespace palpate::test
