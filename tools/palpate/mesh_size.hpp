// SPDX-License-Identifier: GPL-3.0-or-later
// How large a mesh is, and what that says about its unit.
#pragma once

#include <string>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::cli {

/// The box along the axes that holds every point.
struct MeshBox {
  bake::Point low{}, high{};
  [[nodiscard]] bake::Point sides() const;
  [[nodiscard]] bake::Point centre() const;
  /// Its longest side.
  [[nodiscard]] double across() const;
};

/// @param mesh  one point or more
MeshBox box_of(const bake::Mesh& mesh);

/// "0.12 x 0.08 x 0.05".
std::string sides_text(const MeshBox& box);

/// Nothing that a hand feels is longer than this: a mesh that is has another unit.
constexpr double kMostAcross_m = 10;

/// "88 m across: millimetres? --unit-scale 0.001"; empty where the size makes sense in metres.
std::string unit_warning(const MeshBox& box_m);

constexpr double kMillimetre_m = 0.001;

/// Metres of one unit of a mesh, guessed from boxes in units of the files. One program most likely
/// wrote both: where either is longer than kMostAcross_m both are in millimetres, but for one that
/// would be smaller than a millimetre then. Else metres.
double guessed_unit_m(const MeshBox& mesh, const MeshBox& beside);

}  // namespace palpate::cli
