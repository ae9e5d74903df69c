// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/read.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <string>
#include <unordered_map>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/soup.hpp"
#include "host_bake/mesh/text.hpp"
#include "host_bake/mesh/triangulate.hpp"
#include "rt_core/image/sha256.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

std::string load(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) {
    throw InputRefused("cannot be read", file.string(), "check the path and the permissions");
  }
  if (size >= kMaxFileBytes) {
    throw InputRefused("larger than 4 GiB", file.string(), "reduce the mesh first");
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw InputRefused("cannot be read to its end", file.string(), "check the disk");
  }
  return bytes;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

bool is_obj_keyword(std::string_view word) {
  static constexpr std::string_view kWords[] = {"v", "vt", "vn",     "f",     "o",
                                                "g", "s",  "mtllib", "usemtl"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

/// By content first: extensions lie more often than first words. A binary STL may begin with any
/// word, so its size is asked before.
Soup parse(std::string_view bytes, const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string extension = lower_extension(path);
  if (bytes.empty()) throw InputRefused("the file is empty", file, "export the mesh again");
  if (bytes.starts_with("\xFE\xFF") || bytes.starts_with("\xFF\xFE")) {
    throw InputRefused("text in UTF-16", file, "save it as ASCII or UTF-8");
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  const std::string_view word = Text(bytes, file, {.comments = true}).word();
  if (is_binary_stl(bytes)) return read_stl_binary(bytes, file);
  if (word == "ply") return read_ply(bytes, file);
  const bool binary = bytes.substr(0, 512).find('\0') != std::string_view::npos;
  if (equals_caseless(word, "solid") && !binary) return read_stl_ascii(bytes, file);
  if (is_off_keyword(word) || extension == ".off") return read_off(bytes, file);
  if (extension == ".stl") return read_stl_binary(bytes, file);
  if (extension == ".ply") return read_ply(bytes, file);
  if (is_obj_keyword(word) || extension == ".obj") return read_obj(bytes, file);
  throw InputRefused("format not recognised", file, "give an OBJ, PLY, STL or OFF file");
}

void require_sound(const Soup& soup, const std::string& file) {
  if (soup.polygon_ends.empty()) {
    throw InputRefused("no triangles", file, "export a surface, not points or lines");
  }
  for (const std::uint32_t corner : soup.corners) {
    if (corner >= soup.points.size()) {
      throw InputRefused("vertex index " + std::to_string(corner) + " of " +
                             std::to_string(soup.points.size()) + " out of range",
                         file, "export the mesh again");
    }
  }
}

struct PointHash {
  std::size_t operator()(const Point& p) const {
    std::uint64_t hash = 0;
    for (const double x : p) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Makes the soup's indices refer to the distinct referenced points, in the order of first use, and
/// returns those points.
std::vector<Point> weld(Soup& soup, bool merge_equal) {
  std::vector<Point> points;
  std::vector<std::uint32_t> index_of(soup.points.size(), kNone);
  std::unordered_map<Point, std::uint32_t, PointHash> known;
  for (std::uint32_t& corner : soup.corners) {
    std::uint32_t& index = index_of[corner];
    if (index == kNone) {
      Point p = soup.points[corner];
      for (double& x : p) x += 0.0;  // -0 becomes 0
      index = static_cast<std::uint32_t>(points.size());
      if (merge_equal) index = known.try_emplace(p, index).first->second;
      if (index == points.size()) points.push_back(p);
    }
    corner = index;
  }
  return points;
}

void scale(std::vector<Point>& points, double unit_scale, const std::string& file) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (double& x : points[i]) {
      x *= unit_scale;
      if (std::isfinite(x)) continue;
      throw InputRefused("a coordinate is not a finite number", file, "export the mesh again");
    }
  }
}

/// Files of to_ply() say that equal positions are meant to stay apart, as repair() leaves them
/// where sheets touch.
bool says_welded(std::string_view bytes) {
  return bytes.substr(0, 256).find(kWeldedComment) != std::string_view::npos;
}

}  // namespace

ReadMesh read_mesh(const std::filesystem::path& file, double unit_scale) {
  ReadMesh result;
  const std::string bytes = load(file);
  Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  result.sha256 = hash.finish();

  Soup soup = parse(bytes, file);
  require_sound(soup, file.string());
  result.file_vertices = soup.points.size();
  result.file_faces = soup.polygon_ends.size();
  const bool welded = says_welded(bytes);
  result.mesh.points = weld(soup, !welded);
  scale(result.mesh.points, unit_scale, file.string());
  std::size_t begin = 0;
  for (const std::uint32_t end : soup.polygon_ends) {
    triangulate(result.mesh.points, std::span(soup.corners).subspan(begin, end - begin),
                result.mesh.faces);
    begin = end;
  }
  if (!welded) result.welded = weld_coincident(result.mesh);
  if (result.mesh.faces.empty()) {
    throw InputRefused("every triangle is thinner than what positions are rounded by",
                       file.string(), "export a surface with an area");
  }
  return result;
}

}  // namespace palpate::bake
