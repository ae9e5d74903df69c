// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify_judge.hpp"

#include <algorithm>
#include <set>

#include "decompose_oracle.hpp"

namespace palpate::test {
namespace {

using namespace bake;

Mesh in_double(const NormalMesh& mesh) {
  Mesh out;
  for (const auto& p : mesh.points)
    out.points.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  out.faces = mesh.faces;
  return out;
}

long euler_number(const NormalMesh& mesh) {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Face& f : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.insert(f[i]);
      edges.insert(std::minmax({f[i], f[(i + 1) % 3]}));
    }
  return static_cast<long>(vertices.size()) - static_cast<long>(edges.size()) +
         static_cast<long>(mesh.faces.size());
}

/// Entries below `limit`, one for each of `before`, every value named: 0 ... limit - 1.
bool names_all(const std::vector<std::uint32_t>& map, std::size_t before, std::size_t limit) {
  std::set<std::uint32_t> named(map.begin(), map.end());
  return map.size() == before && named.size() == limit && *named.rbegin() == limit - 1;
}

std::string judge_mesh(const SimplifiedLevel& level, const CheckReport& check,
                       const Simplified& result) {
  for (const Finding& f : check.findings)
    if (f.severity != Severity::note) return f.rule;
  if (check.components != result.check.components) return "components";
  if (check.closed_components != result.check.closed_components) return "closed components";
  if (euler_number(level.mesh) != euler_number(result.mesh)) return "Euler number";
  if (check.crossings > result.check.crossings)
    return "crossings: " + std::to_string(check.crossings);
  return {};
}

}  // namespace

Simplified simplified(const Mesh& mesh, const SimplifyOptions& options) {
  Simplified result{normalise(mesh), check(mesh), {}, {}, {}};
  result.patches = decompose(result.mesh, result.check, 1, {});
  result.levels = simplify(result.mesh, result.check, result.patches, options, {}, result.report);
  return result;
}

std::string judge_levels(const Simplified& result) {
  const NormalMesh* mesh = &result.mesh;
  std::size_t patches = result.patches.size();
  double resolution = 1e9;
  for (std::size_t i = 0; i < result.levels.size(); ++i) {
    const SimplifiedLevel& level = result.levels[i];
    const std::string where = "level " + std::to_string(i) + ": ";
    const CheckReport report = check(in_double(level.mesh));
    if (const std::string wrong = judge_mesh(level, report, result); !wrong.empty())
      return where + wrong;
    if (const std::string wrong = judge_patches(level.mesh, report, level.patches, false);
        !wrong.empty())
      return where + wrong;
    if (!names_all(level.parent_of_patch, patches, level.patches.size())) return where + "parents";
    if (!names_all(level.face_of_face, mesh->faces.size(), level.mesh.faces.size()))
      return where + "heirs of faces";
    if (!names_all(level.vertex_of_vertex, mesh->points.size(), level.mesh.points.size()))
      return where + "heirs of vertices";
    if (!(level.resolution > 0) || level.resolution > resolution) return where + "resolution";
    mesh = &level.mesh;
    patches = level.patches.size();
    resolution = level.resolution;
  }
  return {};
}

}  // namespace palpate::test
