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

/// `found` is empty at the end of the file.
void expect(const Text& text, std::string_view wanted, std::string_view found) {
  if (equals_caseless(found, wanted)) return;
  text.refuse("'" + std::string(wanted) + "' missing" +
                  (found.empty() ? ", the file is cut" : " before " + quoted(found)),
              "copy or export the mesh again");
}

void expect(Text& text, std::initializer_list<std::string_view> words) {
  for (const std::string_view wanted : words) expect(text, wanted, text.word());
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

void require_size(std::size_t counted, std::size_t found, const std::string& file) {
  if (found == counted) return;
  const std::string counts = "the header counts " + std::to_string(counted / kFacetBytes) +
                             " triangles but " + std::to_string(found) + " bytes follow, " +
                             std::to_string(kFacetBytes) + " a triangle";
  if (found < counted) {
    throw InputRefused("the file is cut or its count is wrong (" + counts + ")", file,
                       "copy or export the mesh again");
  }
  throw InputRefused(
      std::to_string(found - counted) + " bytes after the last triangle (" + counts + ")", file,
      "remove them if they are no triangles, or export the mesh again");
}

}  // namespace

Soup read_stl_ascii(std::string_view bytes, const std::string& file) {
  Soup soup;
  Text text(bytes, file, {});
  for (;;) {
    const std::string_view word = text.word();
    if (word.empty()) return soup;
    expect(text, "solid", word);
    text.skip_line();  // the name, which may be any text
    std::string_view inner = text.word();
    for (; equals_caseless(inner, "facet"); inner = text.word()) read_facet(text, soup);
    // Some exporters, numpy-stl among them, write two words.
    const bool two_words =
        equals_caseless(inner, "end") && equals_caseless(text.word_on_line(), "solid");
    if (!two_words) expect(text, "endsolid", inner);
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
  require_size(facets * kFacetBytes, in.left(), file);
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
