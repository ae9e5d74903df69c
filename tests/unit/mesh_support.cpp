// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_support.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host_bake/base/error.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::bake::testing {
namespace {

/// A file of this process, gone with the object.
class ScratchFile {
 public:
  ScratchFile(std::string_view bytes, const std::string& extension)
      : path_(::testing::TempDir() + "palpate_mesh_" + std::to_string(::getpid()) + extension) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~ScratchFile() { std::filesystem::remove(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string ply_header(const Mesh& mesh, const std::string& format, const std::string& newline) {
  std::string header;
  for (const std::string& line :
       {std::string("ply"), "format " + format + " 1.0", std::string("comment a test's"),
        "element vertex " + std::to_string(mesh.points.size()), std::string("property float x"),
        std::string("property float y"), std::string("property float z"),
        std::string("property uchar red"), "element face " + std::to_string(mesh.faces.size()),
        std::string("property list uchar int vertex_indices"), std::string("end_header")}) {
    header += line + newline;
  }
  return header;
}

}  // namespace

Mesh cube(Point low, double size) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.points.push_back(
        {low[0] + (i & 1U ? size : 0), low[1] + (i & 2U ? size : 0), low[2] + (i & 4U ? size : 0)});
  }
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh sphere(Point centre, double radius, int subdivisions) {
  Mesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < subdivisions; ++i) {
    const std::size_t known = mesh.points.size();
    mesh = test::quartered(mesh, 1);
    for (std::size_t k = known; k < mesh.points.size(); ++k) {
      Point& p = mesh.points[k];
      const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
      for (double& x : p) x /= length;
    }
  }
  for (Point& p : mesh.points) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = centre[i] + radius * p[i];
  }
  return mesh;
}

Mesh sheet(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.points.push_back({static_cast<double>(x), static_cast<double>(y), 0});
    }
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
      mesh.faces.insert(mesh.faces.end(), {Face{a, a + 1, b + 1}, Face{a, b + 1, b}});
    }
  }
  return mesh;
}

Mesh together(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  const auto offset = static_cast<std::uint32_t>(a.points.size());
  mesh.points.insert(mesh.points.end(), b.points.begin(), b.points.end());
  for (const Face& f : b.faces) mesh.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  return mesh;
}

Mesh inside_out(Mesh mesh) {
  for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  return mesh;
}

ReadMesh read_as(std::string_view bytes, const std::string& extension, double unit_scale) {
  const ScratchFile file(bytes, extension);
  return read_mesh(file.path(), unit_scale);
}

std::string refusal(std::string_view bytes, const std::string& extension) {
  try {
    (void)read_as(bytes, extension);
    return {};
  } catch (const InputRefused& refused) {
    return refused.what();
  }
}

std::string to_obj(const Mesh& mesh) {
  std::ostringstream out;
  for (const Point& p : mesh.points) out << "v " << p[0] << " " << p[1] << " " << p[2] << "\n";
  for (const Face& f : mesh.faces) {
    out << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << "\n";
  }
  return out.str();
}

std::string to_off(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.points.size() << " " << mesh.faces.size() << " 0\n";
  for (const Point& p : mesh.points) out << p[0] << " " << p[1] << " " << p[2] << "\n";
  for (const Face& f : mesh.faces) out << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
  return out.str();
}

std::string to_off_binary(const Mesh& mesh) {
  std::string out = "OFF BINARY\n";
  append(out, static_cast<std::uint32_t>(mesh.points.size()), std::endian::big);
  append(out, static_cast<std::uint32_t>(mesh.faces.size()), std::endian::big);
  append(out, std::uint32_t{0}, std::endian::big);
  for (const Point& p : mesh.points) {
    for (const double x : p) append(out, static_cast<float>(x), std::endian::big);
  }
  for (const Face& f : mesh.faces) {
    append(out, std::uint32_t{3}, std::endian::big);
    for (const std::uint32_t v : f) append(out, v, std::endian::big);
    append(out, std::uint32_t{0}, std::endian::big);
  }
  return out;
}

std::string to_stl_ascii(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid of a test\n";
  for (const Face& f : mesh.faces) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : f) {
      const Point& p = mesh.points[v];
      out << "vertex " << p[0] << " " << p[1] << " " << p[2] << "\n";
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid of a test\n";
  return out.str();
}

std::string to_stl_binary(const Mesh& mesh, const std::string& header) {
  std::string out = header;
  out.resize(80, ' ');
  append(out, static_cast<std::uint32_t>(mesh.faces.size()));
  for (const Face& f : mesh.faces) {
    out.append(12, '\0');
    for (const std::uint32_t v : f) {
      for (const double x : mesh.points[v]) append(out, static_cast<float>(x));
    }
    out.append(2, '\0');
  }
  return out;
}

std::string to_ply_ascii(const Mesh& mesh) {
  std::ostringstream out;
  out << ply_header(mesh, "ascii", "\n");
  for (const Point& p : mesh.points) out << p[0] << " " << p[1] << " " << p[2] << " 255\n";
  for (const Face& f : mesh.faces) out << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
  return out.str();
}

std::string to_ply_binary(const Mesh& mesh, std::endian order, const std::string& newline) {
  std::string out = ply_header(
      mesh, order == std::endian::little ? "binary_little_endian" : "binary_big_endian", newline);
  for (const Point& p : mesh.points) {
    for (const double x : p) append(out, static_cast<float>(x), order);
    out += '\xFF';
  }
  for (const Face& f : mesh.faces) {
    out += '\3';
    for (const std::uint32_t v : f) append(out, v, order);
  }
  return out;
}

}  // namespace palpate::bake::testing
