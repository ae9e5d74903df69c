// SPDX-License-Identifier: GPL-3.0-or-later
// PLY as Greg Turk's "The PLY Polygon File Format" (1994) has it: elements in any order, properties
// of any number type, of which x, y, z of `vertex` and the index lists of `face` are used; and of
// `tristrips`, as files of scanned models have them in place of faces.
#include <array>
#include <optional>
#include <utility>

#include "host_bake/mesh/bytes.hpp"
#include "host_bake/mesh/soup.hpp"
#include "host_bake/mesh/text.hpp"

namespace palpate::bake {
namespace {

enum class Number { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Encoding { ascii, little, big };
enum class Use { none, x, y, z, indices };

struct Property {
  Number type = Number::i8;
  std::optional<Number> count_type;  ///< of a list
  Use use = Use::none;
};

struct Element {
  enum class Kind { vertex, face, strips, other } kind = Kind::other;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
};

constexpr std::size_t kMaxElements = 64;  ///< kinds of elements in a header; real files have 2 to 6
constexpr std::size_t kMaxProperties = 1024;  ///< of one element

Number number_type(std::string_view word, const Text& text) {
  static constexpr std::pair<std::string_view, Number> kNames[] = {
      {"char", Number::i8},    {"int8", Number::i8},     {"uchar", Number::u8},
      {"uint8", Number::u8},   {"short", Number::i16},   {"int16", Number::i16},
      {"ushort", Number::u16}, {"uint16", Number::u16},  {"int", Number::i32},
      {"int32", Number::i32},  {"uint", Number::u32},    {"uint32", Number::u32},
      {"float", Number::f32},  {"float32", Number::f32}, {"double", Number::f64},
      {"float64", Number::f64}};
  for (const auto& [name, type] : kNames) {
    if (word == name) return type;
  }
  text.refuse("unknown number type in the PLY header", "export the mesh again");
}

bool is_float(Number type) { return type == Number::f32 || type == Number::f64; }

std::size_t size_of(Number type) {
  switch (type) {
    case Number::i8:
    case Number::u8:
      return 1;
    case Number::i16:
    case Number::u16:
      return 2;
    case Number::f64:
      return 8;
    default:
      return 4;
  }
}

bool is_surface(Element::Kind kind) {
  return kind == Element::Kind::face || kind == Element::Kind::strips;
}

Use use_of(Element::Kind kind, const Property& property, std::string_view name) {
  if (kind == Element::Kind::vertex && !property.count_type) {
    if (name == "x") return Use::x;
    if (name == "y") return Use::y;
    if (name == "z") return Use::z;
  }
  const bool indices = name == "vertex_indices" || name == "vertex_index";
  const bool list = property.count_type && !is_float(property.type);
  return is_surface(kind) && indices && list ? Use::indices : Use::none;
}

Encoding read_format(Text& text) {
  const std::string_view word = text.word_on_line();
  if (word == "ascii") return Encoding::ascii;
  if (word == "binary_little_endian") return Encoding::little;
  if (word == "binary_big_endian") return Encoding::big;
  text.refuse("unknown PLY format", "save as ascii or binary PLY");
}

Element read_element(Text& text) {
  Element element;
  const std::string_view name = text.word_on_line();
  if (name == "vertex") element.kind = Element::Kind::vertex;
  if (name == "face") element.kind = Element::Kind::face;
  if (name == "tristrips") element.kind = Element::Kind::strips;
  const std::int64_t count = text.integer(text.word_on_line(), "count");
  if (count < 0 || static_cast<std::uint64_t>(count) > text.left()) {
    text.refuse("the count " + std::to_string(count) + " does not fit the size of the file",
                "copy or export the mesh again");
  }
  element.count = static_cast<std::size_t>(count);
  return element;
}

Property read_property(Text& text, Element::Kind kind) {
  Property property;
  std::string_view word = text.word_on_line();
  if (word == "list") {
    property.count_type = number_type(text.word_on_line(), text);
    if (is_float(*property.count_type)) {
      text.refuse("a list counted in floating point", "export the mesh again");
    }
    word = text.word_on_line();
  }
  property.type = number_type(word, text);
  property.use = use_of(kind, property, text.word_on_line());
  return property;
}

/// From behind the word `ply` to the first byte of the data.
PlyHeader read_header(Text& text) {
  PlyHeader header;
  std::string_view line_end;
  for (;;) {
    line_end = text.skip_line();
    const std::string_view keyword = text.word_on_line();
    if (keyword == "end_header") break;
    if (text.at_end()) text.refuse("'end_header' missing", "copy or export the mesh again");
    if (keyword == "format") header.encoding = read_format(text);
    if (keyword == "element") header.elements.push_back(read_element(text));
    if (keyword == "property" && !header.elements.empty()) {
      Element& element = header.elements.back();
      element.properties.push_back(read_property(text, element.kind));
    }
    if (header.elements.size() > kMaxElements ||
        (!header.elements.empty() && header.elements.back().properties.size() > kMaxProperties)) {
      text.refuse("the PLY header is too long", "export the mesh again");
    }
  }
  text.skip_line_ending_as(line_end);
  return header;
}

/// The data as a stream of numbers, whatever the encoding.
class Stream {
 public:
  Stream(Text& text, const std::string& file, Encoding encoding)
      : text_(text),
        bytes_(text.rest(), file,
               encoding == Encoding::big ? std::endian::big : std::endian::little),
        ascii_(encoding == Encoding::ascii) {}

  double number(Number type) {
    if (ascii_) return text_.number(text_.word(), "number");
    switch (type) {
      case Number::i8:
        return static_cast<double>(bytes_.read<std::int8_t>());
      case Number::u8:
        return static_cast<double>(bytes_.read<std::uint8_t>());
      case Number::i16:
        return static_cast<double>(bytes_.read<std::int16_t>());
      case Number::u16:
        return static_cast<double>(bytes_.read<std::uint16_t>());
      case Number::i32:
        return static_cast<double>(bytes_.read<std::int32_t>());
      case Number::u32:
        return static_cast<double>(bytes_.read<std::uint32_t>());
      case Number::f32:
        return static_cast<double>(bytes_.read<float>());
      case Number::f64:
        return bytes_.read<double>();
    }
    return 0;
  }

  /// A count or an index: no type wider than 32 bits, so nothing is lost in a double.
  std::uint32_t index(Number type) { return whole(number(type)); }

  /// An index of a list of strips; none where the list has -1: the next strip begins there.
  std::optional<std::uint32_t> strip_index(Number type) {
    const double value = number(type);
    if (value == -1) return std::nullopt;
    return whole(value);
  }

  /// Throws unless `count` numbers of the type can still follow.
  void require(std::size_t count, Number type) const {
    if (!ascii_) return bytes_.require(count, size_of(type));
    if (count > text_.left()) text_.refuse("the file is cut", "copy or export the mesh again");
  }

 private:
  std::uint32_t whole(double value) const {
    if (!(value >= 0 && value < 4294967295.0 &&
          value == static_cast<double>(static_cast<std::uint32_t>(value)))) {
      text_.refuse("a count or index that is negative or not whole", "export the mesh again");
    }
    return static_cast<std::uint32_t>(value);
  }

  Text& text_;
  Bytes bytes_;
  bool ascii_;
};

void read_list(Stream& in, const Property& property, Soup& soup) {
  const std::uint32_t count = in.index(*property.count_type);
  in.require(count, property.type);
  const bool polygon = property.use == Use::indices && count >= 3;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (polygon) {
      soup.corners.push_back(in.index(property.type));
    } else {
      (void)in.number(property.type);
    }
  }
  if (polygon) soup.end_polygon();
}

/// Each index makes a triangle with the two before it, turned round every second time. Those that
/// name a vertex twice only lead from one part of a strip to the next.
void read_strips(Stream& in, const Property& property, Soup& soup) {
  const std::uint32_t count = in.index(*property.count_type);
  in.require(count, property.type);
  std::array<std::uint32_t, 2> last{};
  std::size_t length = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::optional<std::uint32_t> index = in.strip_index(property.type);
    if (!index) {
      length = 0;
      continue;
    }
    if (length >= 2 && last[0] != last[1] && last[0] != *index && last[1] != *index) {
      const std::size_t turned = length % 2;
      soup.corners.insert(soup.corners.end(), {last[turned], last[1 - turned], *index});
      soup.end_polygon();
    }
    last = {last[1], *index};
    ++length;
  }
}

void read_items(Stream& in, const Element& element, Soup& soup) {
  // No property, no data: the count alone must not cost time.
  for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
    Point p{};
    for (const Property& property : element.properties) {
      if (property.count_type) {
        const bool strips = element.kind == Element::Kind::strips && property.use == Use::indices;
        (strips ? read_strips : read_list)(in, property, soup);
        continue;
      }
      const double value = in.number(property.type);
      if (property.use == Use::x) p[0] = value;
      if (property.use == Use::y) p[1] = value;
      if (property.use == Use::z) p[2] = value;
    }
    if (element.kind == Element::Kind::vertex) soup.points.push_back(p);
  }
}

bool has(const Element& element, Use use) {
  for (const Property& property : element.properties) {
    if (property.use == use) return true;
  }
  return false;
}

void require_usable(const PlyHeader& header, const Text& text) {
  for (const Element& element : header.elements) {
    const bool vertex = element.kind == Element::Kind::vertex;
    if (vertex && !(has(element, Use::x) && has(element, Use::y) && has(element, Use::z))) {
      text.refuse("vertices without x, y and z", "export the mesh again");
    }
    if (is_surface(element.kind) && !has(element, Use::indices)) {
      text.refuse("faces without vertex_indices", "export the mesh again as triangles");
    }
  }
}

}  // namespace

Soup read_ply(std::string_view bytes, const std::string& file) {
  Text text(bytes, file, {});
  if (text.word() != "ply") text.refuse("not a PLY file", "check the file's name and content");
  const PlyHeader header = read_header(text);
  require_usable(header, text);
  Soup soup;
  Stream in(text, file, header.encoding);
  for (const Element& element : header.elements) read_items(in, element, soup);
  return soup;
}

}  // namespace palpate::bake
