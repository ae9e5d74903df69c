// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>

#include "host_bake/emit/emit.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kBytesPerLine = 16;
constexpr char kDigits[] = "0123456789abcdef";

std::string comment(std::span<const std::byte> image) {
  image::Header header;
  std::memcpy(&header, image.data(), sizeof(header));
  std::string text = "/* Palpate image, format " + std::to_string(header.format_major) + "." +
                     std::to_string(header.format_minor) + ", " + std::to_string(image.size()) +
                     " bytes, content SHA-256\n   ";
  for (const std::uint8_t b : header.content_sha256) {
    text += kDigits[b >> 4];
    text += kDigits[b & 15];
  }
  return text + ". Made by palpate emit; do not edit. */\n";
}

void append_bytes(std::span<const std::byte> bytes, std::string& out) {
  out.reserve(out.size() + bytes.size() * 5 + bytes.size() / kBytesPerLine + kBytesPerLine);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto b = std::to_integer<unsigned>(bytes[i]);
    out += "0x";
    out += kDigits[b >> 4];
    out += kDigits[b & 15];
    out += (i + 1) % kBytesPerLine == 0 || i + 1 == bytes.size() ? ",\n" : ",";
  }
}

}  // namespace

std::string to_c_array(std::span<const std::byte> image, std::string_view symbol,
                       std::string_view section) {
  const std::string name(symbol);
  const std::string array =
      "const unsigned char " + name + "[" + std::to_string(image.size()) + "]";
  const std::string size = "const unsigned long " + name + "_size";
  std::string out = comment(image);
  // A const object of C++ has internal linkage unless a declaration before it says otherwise.
  out += "#ifdef __cplusplus\nextern \"C\" {\nextern " + array + ";\nextern " + size +
         ";\nalignas(64)\n#else\n_Alignas(64)\n#endif\n";
  if (!section.empty()) {
    out += "__attribute__((section(\"" + std::string(section) + "\")))\n";
  }
  out += array + " = {\n";
  append_bytes(image, out);
  out += "};\n" + size + " = " + std::to_string(image.size()) + "UL;\n";
  return out + "#ifdef __cplusplus\n}\n#endif\n";
}

}  // namespace palpate::bake
