// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: `v` and `f` lines; everything else (normals, textures, groups, points, lines,
// curves) says nothing about the surface and is passed over.
#include "host_bake/mesh/soup.hpp"
#include "host_bake/mesh/text.hpp"

namespace palpate::bake {
namespace {

/// "7", "7/2", "7/2/3" or "7//3", counted from 1, or back from the last vertex so far where
/// negative.
std::uint32_t vertex_index(const Text& text, std::string_view word, std::size_t points_so_far) {
  const std::int64_t index = text.integer(word.substr(0, word.find('/')), "vertex index");
  const auto count = static_cast<std::int64_t>(points_so_far);
  const std::int64_t from_zero = index < 0 ? count + index : index - 1;
  if (index == 0 || from_zero < 0 || from_zero >= std::int64_t{kMaxFileBytes} - 1) {
    text.refuse("vertex index " + std::to_string(index) + " out of range", "export the mesh again");
  }
  return static_cast<std::uint32_t>(from_zero);
}

void read_face(Text& text, Soup& soup) {
  const std::size_t begin = soup.corners.size();
  for (std::string_view word; !(word = text.word_on_line()).empty();) {
    soup.corners.push_back(vertex_index(text, word, soup.points.size()));
  }
  if (soup.corners.size() - begin < 3) {
    text.refuse("face with fewer than three vertices", "remove it or export the mesh again");
  }
  soup.end_polygon();
}

}  // namespace

Soup read_obj(std::string_view bytes, const std::string& file) {
  Soup soup;
  Text text(bytes, file, {.comments = true, .continuations = true});
  for (; !text.at_end(); text.skip_line()) {
    const std::string_view keyword = text.word_on_line();
    if (keyword == "v") {
      Point& p = soup.points.emplace_back();
      for (double& x : p) x = text.number(text.word_on_line(), "coordinate");
    } else if (keyword == "f") {
      read_face(text, soup);
    }
  }
  return soup;
}

}  // namespace palpate::bake
