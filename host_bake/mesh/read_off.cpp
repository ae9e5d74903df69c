// SPDX-License-Identifier: GPL-3.0-or-later
// OFF as Geomview's manual defines it (object file formats, OFF): keyword, three counts, a line a
// vertex, a line a face.
#include "host_bake/mesh/bytes.hpp"
#include "host_bake/mesh/soup.hpp"
#include "host_bake/mesh/text.hpp"

namespace palpate::bake {
namespace {

struct OffHeader {
  bool textures = false, colours = false, normals = false;  ///< extra numbers a vertex (ST, C, N)
  bool supported = true;                                    ///< not 4OFF or nOFF: points beyond 3D
};

/// False where the word is no OFF keyword.
bool parse_keyword(std::string_view word, OffHeader& out) {
  const auto take = [&word](std::string_view prefix) {
    const bool found = word.starts_with(prefix);
    if (found) word.remove_prefix(prefix.size());
    return found;
  };
  out.textures = take("ST");
  out.colours = take("C");
  out.normals = take("N");
  const bool four = take("4");
  out.supported = !take("n") && !four;
  return word == "OFF";
}

std::uint32_t in_range(std::int64_t index, std::size_t points, const Text& text) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= points) {
    text.refuse("vertex index " + std::to_string(index) + " out of range", "export the mesh again");
  }
  return static_cast<std::uint32_t>(index);
}

/// The colours behind a face's indices are passed over with the rest of its line.
Soup read_text(Text& text, std::string_view first_count) {
  const auto count = [&text](std::string_view word) {
    const std::int64_t value = text.integer(word, "count");
    // A vertex or a face takes more than one byte, so this bounds what a lying count can make us
    // do.
    if (value < 0 || static_cast<std::uint64_t>(value) > text.left()) {
      text.refuse("the count " + std::to_string(value) + " does not fit the size of the file",
                  "copy or export the mesh again");
    }
    return static_cast<std::size_t>(value);
  };
  Soup soup;
  const std::size_t points = count(first_count);
  const std::size_t faces = count(text.word());
  text.skip_line();  // the count of edges, which some writers leave out
  for (std::size_t i = 0; i < points; ++i, text.skip_line()) {
    Point& p = soup.points.emplace_back();
    p[0] = text.number(text.word(), "coordinate");
    for (std::size_t k = 1; k < 3; ++k) p[k] = text.number(text.word_on_line(), "coordinate");
  }
  for (std::size_t i = 0; i < faces; ++i, text.skip_line()) {
    const std::size_t size = count(text.word());
    if (size < 3) continue;  // points and lines
    for (std::size_t k = 0; k < size; ++k) {
      const std::int64_t index = text.integer(text.word_on_line(), "vertex index");
      soup.corners.push_back(in_range(index, points, text));
    }
    soup.end_polygon();
  }
  return soup;
}

std::size_t read_count(Bytes& bytes, std::size_t each) {
  const auto count = static_cast<std::size_t>(bytes.read<std::uint32_t>());
  bytes.require(count, each);
  return count;
}

Soup read_binary(Bytes bytes, const OffHeader& header) {
  Soup soup;
  const std::size_t extra =
      sizeof(float) * ((header.normals ? 3U : 0U) + (header.textures ? 2U : 0U));
  const std::size_t points = read_count(bytes, 3 * sizeof(float) + extra);
  const auto faces = bytes.read<std::uint32_t>();
  bytes.skip(sizeof(std::uint32_t));  // edges
  bytes.require(faces, 2 * sizeof(std::uint32_t));
  for (std::size_t i = 0; i < points; ++i) {
    Point& p = soup.points.emplace_back();
    for (double& x : p) x = static_cast<double>(bytes.read<float>());
    bytes.skip(extra + (header.colours ? 4 * sizeof(float) : 0));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    const std::size_t size = read_count(bytes, sizeof(std::uint32_t));
    for (std::size_t k = 0; k < size; ++k) {
      const auto index = bytes.read<std::uint32_t>();
      if (size >= 3) soup.corners.push_back(index);
    }
    if (size >= 3) soup.end_polygon();
    bytes.skip(sizeof(float) * read_count(bytes, sizeof(float)));  // colour components
  }
  return soup;
}

}  // namespace

bool is_off_keyword(std::string_view word) {
  OffHeader header;
  return parse_keyword(word, header);
}

Soup read_off(std::string_view bytes, const std::string& file) {
  Text text(bytes, file, {.comments = true});
  OffHeader header;
  std::string_view word = text.word();
  // The keyword may be left out; then the file begins with the counts.
  if (parse_keyword(word, header)) {
    if (!header.supported) text.refuse("points of other than three coordinates", "save as OFF");
    word = text.word();
    if (word == "BINARY") {
      text.skip_line();
      return read_binary(Bytes(text.rest(), file, std::endian::big), header);
    }
  }
  return read_text(text, word);
}

}  // namespace palpate::bake
