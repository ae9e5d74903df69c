// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/file_format.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace palpate::cli {
namespace {

constexpr std::string_view kOfSomeFormat[] = {
    ".ply",  ".stl", ".obj", ".off",  ".3mf", ".gltf", ".glb",  ".step", ".stp",
    ".wrl",  ".dae", ".png", ".jpg",  ".gif", ".bmp",  ".tif",  ".tiff", ".svg",
    ".webp", ".pdf", ".ps",  ".jpeg", ".csv", ".mcap", ".toml", ".bin",  ".hex",
    ".elf",  ".dfu", ".c",   ".html", ".txt", ".json", ".palp", ".trace"};

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string wrong_name(const std::string& file, std::string_view extension) {
  const std::filesystem::path name(file);
  const std::string found = small_letters(name.extension().string());
  const bool of_other =
      found != extension && std::find(std::begin(kOfSomeFormat), std::end(kOfSomeFormat), found) !=
                                std::end(kOfSomeFormat);
  if (!of_other) return {};
  const std::string written = std::filesystem::path(name).replace_extension(extension).string();
  return "'" + file + "' is named as another format than what is written: give '" + written + "'";
}

CLI::Validator named_as(std::string_view extension) {
  return {[extension](const std::string& file) { return wrong_name(file, extension); }, "",
          "format"};
}

}  // namespace palpate::cli
