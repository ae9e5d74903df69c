// SPDX-License-Identifier: GPL-3.0-or-later
// An independent judge of decompositions: whole numbers, brute force, sampling. It shares no code
// with what it judges.
#pragma once

#include <string>
#include <vector>

#include "host_bake/decompose/decompose.hpp"

namespace palpate::test {

/// What is wrong with a decomposition, or nothing: the partition, the three constraints, hulls,
/// virtual faces, flags; with `connected` also that the faces of a patch hang together over edges.
std::string judge_patches(const bake::NormalMesh& mesh, const bake::CheckReport& report,
                          const std::vector<bake::Patch>& patches, bool connected = true);

}  // namespace palpate::test
