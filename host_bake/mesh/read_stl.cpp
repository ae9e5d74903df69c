// SPDX-License-Identifier: GPL-3.0-or-later
// STL as the StereoLithography Interface Specification (3D Systems, 1989) has it; keywords in
// either case, any number of solids.
#include <bit>
#include <initializer_list>

#include "host_bake/mesh/bytes.hpp"
#include "host_bake/mesh/soup.hpp"
#include "host_bake/mesh/text.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;  ///< normal, three vertices, attribute

void push_corner(Soup& soup, const Point& p) {
  soup.corners.push_back(static_cast<std::uint32_t>(soup.points.size()));
  soup.points.push_back(p);
}

void expect(Text& text, std::initializer_list<std::string_view> words) {
  for (const std::string_view wanted : words) {
    if (!equals_caseless(text.word(), wanted)) {
      text.refuse("'" + std::string(wanted) + "' missing", "copy or export the mesh again");
    }
  }
}

/// Behind the word `facet`. The normal is passed over: the order of the vertices says the same and
/// is not rounded.
void read_facet(Text& text, Soup& soup) {
  expect(text, {"normal"});
  for (int i = 0; i < 3; ++i) (void)text.word();
  expect(text, {"outer", "loop"});
  for (int i = 0; i < 3; ++i) {
    expect(text, {"vertex"});
    Point p;
    for (double& x : p) x = text.number(text.word(), "coordinate");
    push_corner(soup, p);
  }
  expect(text, {"endloop", "endfacet"});
  soup.end_polygon();
}

}  // namespace

Soup read_stl_ascii(std::string_view bytes, const std::string& file) {
  Soup soup;
  Text text(bytes, file, {});
  for (;;) {
    const std::string_view word = text.word();
    if (word.empty()) return soup;
    if (!equals_caseless(word, "solid")) text.refuse("'solid' missing", "export the mesh again");
    text.skip_line();  // the name, which may be any text
    std::string_view inner = text.word();
    for (; equals_caseless(inner, "facet"); inner = text.word()) read_facet(text, soup);
    if (!equals_caseless(inner, "endsolid")) {
      text.refuse("'endsolid' missing", "copy or export the mesh again");
    }
    text.skip_line();
  }
}

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes + sizeof(std::uint32_t)) return false;
  Bytes count(bytes.substr(kHeaderBytes), {}, std::endian::little);
  return count.read<std::uint32_t>() * kFacetBytes == count.left();
}

Soup read_stl_binary(std::string_view bytes, const std::string& file) {
  Bytes in(bytes, file, std::endian::little);
  in.skip(kHeaderBytes);
  const auto facets = in.read<std::uint32_t>();
  if (facets * kFacetBytes != in.left()) {
    throw InputRefused("the header counts " + std::to_string(facets) + " triangles but " +
                           std::to_string(in.left()) + " bytes follow, " +
                           std::to_string(kFacetBytes) + " a triangle",
                       file, "copy or export the mesh again");
  }
  Soup soup;
  soup.points.reserve(3 * std::size_t{facets});
  soup.corners.reserve(3 * std::size_t{facets});
  for (std::uint32_t i = 0; i < facets; ++i) {
    in.skip(3 * sizeof(float));
    for (int corner = 0; corner < 3; ++corner) {
      Point p;
      for (double& x : p) x = static_cast<double>(in.read<float>());
      push_corner(soup, p);
    }
    in.skip(sizeof(std::uint16_t));
    soup.end_polygon();
  }
  return soup;
}

}  // namespace palpate::bake
