// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/mesh_size.hpp"

#include <algorithm>
#include <cstdio>

namespace palpate::cli {

bake::Point MeshBox::sides() const {
  return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

bake::Point MeshBox::centre() const {
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

double MeshBox::across() const {
  const bake::Point all = sides();
  return *std::max_element(all.begin(), all.end());
}

MeshBox box_of(const bake::Mesh& mesh) {
  MeshBox box{mesh.points.front(), mesh.points.front()};
  for (const bake::Point& p : mesh.points) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      box.low[i] = std::min(box.low[i], p[i]);
      box.high[i] = std::max(box.high[i], p[i]);
    }
  }
  return box;
}

std::string sides_text(const MeshBox& box) {
  const bake::Point s = box.sides();
  char text[96];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g", s[0], s[1], s[2]);
  return text;
}

std::string unit_warning(const MeshBox& box_m) {
  if (box_m.across() <= kMostAcross_m) return {};
  char text[96];
  std::snprintf(text, sizeof text, "%.4g m across: millimetres? --unit-scale 0.001",
                box_m.across());
  return text;
}

double guessed_unit_m(const MeshBox& mesh, const MeshBox& beside) {
  const bool millimetres = std::max(mesh.across(), beside.across()) > kMostAcross_m;
  return millimetres && mesh.across() >= 1 ? kMillimetre_m : 1;
}

}  // namespace palpate::cli
