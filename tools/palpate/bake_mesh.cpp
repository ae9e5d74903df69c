// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/bake_mesh.hpp"

namespace palpate::cli {

Baked bake_mesh(bake::ReadMesh read, const std::string& file, const BakeRules& rules,
                bake::BakeOptions how, const bake::Progress& progress) {
  Baked out;
  out.welded = read.welded;
  std::string checked = file;
  if (rules.repair) {
    progress("repair", 0);
    out.repairs = bake::repair(read.mesh).done;
    checked += " after repair";
  }
  progress("check", 0);
  const bake::CheckReport check = bake::check(read.mesh);
  bake::require_bakeable(check, checked, rules.strict);
  how.repaired = !out.repairs.empty();
  how.source_sha256 = read.sha256;
  out.bytes = bake::bake(read.mesh, check, how, progress, out.report);
  return out;
}

}  // namespace palpate::cli
