// SPDX-License-Identifier: GPL-3.0-or-later
// palpate check: what a mesh is, what is wrong with it and where, and what a safe repair makes of
// it.
#include "host_bake/mesh/check.hpp"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "host_bake/mesh/read.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/mesh_size.hpp"

namespace palpate::cli {
namespace {

struct CheckOptions {
  std::string mesh;
  std::string repaired;  ///< empty: none
  double unit_scale = 1.0;
  bool json = false;
  bool quiet = false;
};

const char* name_of(bake::Severity severity) {
  switch (severity) {
    case bake::Severity::note:
      return "note";
    case bake::Severity::repairable:
      return "repairable";
    case bake::Severity::error:
      return "error";
  }
  return "";
}

void print(const bake::Mesh& mesh, const bake::Welded& welded, const bake::CheckReport& report,
           const std::string& file) {
  std::cout << file << "\n  " << report.faces << " triangles, " << report.vertices << " vertices, "
            << sides_text(box_of(mesh)) << " m\n  components: " << report.components << " ("
            << report.closed_components << " closed), boundary edges: " << report.boundary_edges
            << ", self-intersecting pairs: " << report.crossings << "\n";
  if (welded.corners > 0) std::cout << "  welded: " << describe(welded) << "\n";
  for (const bake::Finding& finding : report.findings) {
    std::cout << "  " << name_of(finding.severity) << ": " << bake::describe(finding) << "\n      "
              << finding.fix << "\n";
  }
  std::cout << (report.bakeable() ? "  can be baked\n" : "  cannot be baked as it is\n");
}

nlohmann::json to_json(const bake::CheckReport& report) {
  nlohmann::json findings = nlohmann::json::array();
  for (const bake::Finding& finding : report.findings) {
    findings.push_back({{"rule", finding.rule},
                        {"severity", name_of(finding.severity)},
                        {"count", finding.count},
                        {"first_m", finding.first},
                        {"mend", finding.fix}});
    if (finding.largest_gap_m > 0) findings.back()["largest_gap_m"] = finding.largest_gap_m;
  }
  return {{"bakeable", report.bakeable()},
          {"triangles", report.faces},
          {"vertices", report.vertices},
          {"components", report.components},
          {"closed_components", report.closed_components},
          {"boundary_edges", report.boundary_edges},
          {"self_intersections", report.crossings},
          {"findings", findings}};
}

nlohmann::json to_json(const bake::Welded& welded) {
  return {{"corners", welded.corners},
          {"largest_gap_m", welded.largest_gap_m},
          {"collapsed_triangles", welded.collapsed_triangles}};
}

void print(const bake::RepairReport& repaired) {
  std::cout << "repair\n";
  for (const std::string& line : repaired.done) std::cout << "  " << line << "\n";
  if (repaired.done.empty()) std::cout << "  nothing to fix\n";
}

void check(const CheckOptions& options) {
  const bool text = !options.json && !options.quiet;
  const bake::Progress progress = cli::progress(options.quiet);
  progress("read", 0);
  bake::ReadMesh read = bake::read_mesh(options.mesh, options.unit_scale);
  bake::Mesh& mesh = read.mesh;
  progress("check", 0);
  bake::CheckReport report = bake::check(mesh);
  nlohmann::json json = to_json(report);
  json["file"] = options.mesh;
  json["welded"] = to_json(read.welded);
  if (text) print(mesh, read.welded, report, options.mesh);

  std::string checked = options.mesh;
  if (!options.repaired.empty()) {
    progress("repair", 0);
    const bake::RepairReport repaired = bake::repair(mesh);
    report = bake::check(mesh);
    json["repair"] = {{"done", repaired.done}, {"result", to_json(report)}};
    checked += " after repair";
    if (text) print(repaired);
    if (text) print(mesh, {}, report, checked);
  }
  if (options.json) std::cout << json.dump(2) << "\n";
  bake::require_bakeable(report, checked, false);
  if (options.repaired.empty()) return;
  write_file(options.repaired, std::span<const std::byte>(bake::to_ply(mesh)));
  if (text) std::cout << "written: " << options.repaired << "\n";
}

}  // namespace

void add_check(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "Say whether a mesh can be baked, what is wrong with it, and where");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("mesh", options->mesh, "OBJ, PLY, STL or OFF file")->required();
  command
      ->add_option("--repair", options->repaired,
                   "Write what a safe repair makes of it (PLY, in metres)")
      ->check(named_as(".ply"));
  command->add_option("--unit-scale", options->unit_scale, "Metres of one unit of the file")
      ->check(number_between(1e-15, 1e15))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one JSON object");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options] { check(*options); });
}

}  // namespace palpate::cli
