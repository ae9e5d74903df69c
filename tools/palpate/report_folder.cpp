// SPDX-License-Identifier: GPL-3.0-or-later
// Reports from folders: files are told apart by their first lines, not by their names.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/report_input.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

/// Files of each kind, by name.
struct Found {
  std::vector<fs::path> ticks, contacts, poses, scenes;
  std::vector<fs::path> abouts;  ///< what `palpate replay` says of its tables
};

std::string first_line(const fs::path& file) {
  // The longest header, and its line end: a file of another kind may have no line end at all.
  std::string text(std::max(kTicksHeader.size(), kContactsHeader.size()) + 2, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text.substr(0, text.find_first_of("\r\n"));
}

void sort_in(const fs::path& file, Found& out) {
  if (file.extension() == ".toml") out.scenes.push_back(file);
  if (file.filename().string().ends_with(".about.json")) out.abouts.push_back(file);
  if (file.extension() != ".csv") return;
  const std::string header = first_line(file);
  if (header == kTicksHeader) out.ticks.push_back(file);
  if (header == kContactsHeader) out.contacts.push_back(file);
  if (header == kPosesHeader) out.poses.push_back(file);
}

/// The folder's own files and those of its `ticks` folder, where a sweep keeps its tables.
Found look_into(const fs::path& folder) {
  Found found;
  for (const fs::path& place : {folder, folder / "ticks"}) {
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(place, absent)) {
      if (entry.is_regular_file(absent)) sort_in(entry.path(), found);
    }
  }
  for (auto* files : {&found.ticks, &found.contacts, &found.poses, &found.scenes, &found.abouts}) {
    std::sort(files->begin(), files->end());
  }
  return found;
}

std::vector<TickRow> read_ticks(const fs::path& file) {
  std::string text;
  const std::error_code error = config::read_text(file, text);
  auto rows = error ? std::nullopt : ticks_from_csv(text);
  if (!rows || rows->empty()) {
    throw Failure(kRefused, "not a whole table of ticks", file.string(),
                  "make it again with 'palpate replay' or 'palpate sweep'");
  }
  return std::move(*rows);
}

/// A table of ticks before it is read.
struct Table {
  fs::path file;
  std::string name;  ///< of its line
  bool exact = false;
  bool best = false;  ///< of the Pareto front
};

Table describe(const fs::path& file, const std::vector<SweepPoint>& settings) {
  const std::string stem = file.stem().string();
  const auto point = std::find_if(settings.begin(), settings.end(),
                                  [&](const SweepPoint& p) { return p.id == stem; });
  if (point == settings.end()) return {file, stem, stem.starts_with("exact"), false};
  return {file, point->engine + ", " + point->words, point->exact, point->pareto};
}

/// Those that are shown: exact ones first, then those of the Pareto front, then the others.
std::vector<Table> choose_tables(const Found& found, ReportInput& out) {
  std::vector<Table> tables;
  for (const fs::path& file : found.ticks) tables.push_back(describe(file, out.settings));
  const auto rank = [](const Table& table) { return table.exact ? 0 : table.best ? 1 : 2; };
  std::stable_sort(tables.begin(), tables.end(),
                   [&](const Table& a, const Table& b) { return rank(a) < rank(b); });
  if (tables.size() > kMaxReportLines) {
    out.notes.push_back("Profiles show " + std::to_string(kMaxReportLines) + " of " +
                        std::to_string(tables.size()) +
                        " tables: exact ones first, then the best trades.");
    tables.resize(kMaxReportLines);
  }
  return tables;
}

void read_lines(const std::vector<Table>& tables, ReportInput& out) {
  for (const Table& table : tables) {
    ReportLine& line = out.lines.emplace_back();
    line.name = table.name;
    line.exact = table.exact;
    line.ticks = read_ticks(table.file);
    if (line.ticks.size() != out.lines.front().ticks.size()) {
      throw Failure(kRefused, "tables of different lengths in one folder", table.file.string(),
                    "give each motion a folder of its own");
    }
  }
}

/// An empty object where there is no such file.
nlohmann::json object_in(const fs::path& file) {
  std::string text;
  if (config::read_text(file, text)) return nlohmann::json::object();
  auto json = nlohmann::json::parse(text, nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

/// What a sweep says of itself, or else what replays say of theirs: as far as they agree, and as
/// far as it is still there, for a folder may have been moved.
nlohmann::json about(const fs::path& folder, const Found& found) {
  if (fs::exists(folder / "about.json")) return object_in(folder / "about.json");
  nlohmann::json out = nlohmann::json::object();
  for (const char* key : {"scene", "poses"}) {
    std::set<std::string> named;
    for (const fs::path& file : found.abouts) {
      const nlohmann::json json = object_in(file);
      if (json.contains(key) && json[key].is_string()) named.insert(json[key].get<std::string>());
    }
    std::error_code error;
    if (named.size() == 1 && fs::exists(*named.begin(), error)) out[key] = *named.begin();
  }
  return out;
}

/// What the command line names, else what the sweep or replay was made from, else the folder's only
/// one.
fs::path choose(const fs::path& hint, const nlohmann::json& about, const char* key,
                const std::vector<fs::path>& found) {
  if (!hint.empty()) return hint;
  const auto named = about.find(key);
  if (named != about.end() && named->is_string()) return named->get<std::string>();
  return found.size() == 1 ? found.front() : fs::path();
}

/// "s0_1_contacts" is of "s0_1" or "s0_1_ticks", "contacts" of "ticks".
std::string base_of(std::string name) {
  for (const char* word : {"contacts", "ticks"}) {
    if (const std::size_t at = name.find(word); at != std::string::npos) {
      name.erase(at, std::char_traits<char>::length(word));
    }
  }
  while (name.ends_with('_') || name.ends_with('-') || name.ends_with('.')) name.pop_back();
  return name;
}

/// Contacts of a table that is not exact before those of one that is: they are chosen levels.
void pair_contacts(const Found& found, const std::vector<Table>& tables, ReportScene& out) {
  for (const bool exact : {false, true}) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (tables[i].exact != exact) continue;
      for (const fs::path& file : found.contacts) {
        const bool only = found.contacts.size() == 1 && tables.size() == 1;
        if (!only && base_of(file.stem()) != base_of(tables[i].file.stem())) continue;
        out.contacts = file;
        out.contacts_of = i;
        return;
      }
    }
  }
}

double largest_radius_m(const config::Scene& scene) {
  std::set<fs::path> images;
  for (const config::Body& body : scene.bodies) images.insert(body.image);
  double radius_m = 0;
  for (const fs::path& file : images) {
    radius_m = std::max(radius_m, ImageFile(file).view().header->radius_m);
  }
  return radius_m;
}

void read_view(const Found& found, const std::vector<Table>& tables, const fs::path& folder,
               const ReportHints& hints, ReportInput& out) {
  const nlohmann::json json = about(folder, found);
  const fs::path scene = choose(hints.scene, json, "scene", found.scenes);
  const fs::path poses = choose(hints.poses, json, "poses", found.poses);
  if (scene.empty() || poses.empty()) {
    out.notes.push_back(std::string("No 3D view: the folder does not say which ") +
                        (scene.empty() ? "scene" : "poses") + " it is of; give " +
                        (scene.empty() ? "--scene." : "--poses."));
    return;
  }
  ReportScene view;
  view.scene = config::load_scene(scene);
  view.track = read_poses(poses, view.scene);
  const std::size_t ticks = out.lines.front().ticks.size();
  if (view.track.ticks.size() != ticks) {
    throw Failure(
        kRefused,
        std::to_string(view.track.ticks.size()) + " poses for " + std::to_string(ticks) + " ticks",
        poses.string(), "give the poses that were replayed");
  }
  pair_contacts(found, tables, view);
  if (out.kind == ReportKind::replay && tables.front().exact) {  // exact ones come first
    out.judged = {view.scene.settings.delta_m, largest_radius_m(view.scene)};
  }
  out.view = std::move(view);
}

}  // namespace

ReportInput read_report_folder(const fs::path& folder, const ReportHints& hints) {
  ReportInput input;
  input.name = fs::weakly_canonical(folder).filename().string();
  if (fs::exists(folder / "sweep.json")) {
    input.kind = ReportKind::sweep;
    input.settings = read_sweep(folder / "sweep.json");
  }
  const Found found = look_into(folder);
  if (found.ticks.empty() && input.settings.empty()) {
    throw Failure(kRefused, "nothing to report", folder.string(),
                  "give a folder with the tables of 'palpate replay' or 'palpate sweep'");
  }
  if (found.ticks.empty()) {
    input.notes.emplace_back("No profiles and no 3D view: the folder has no tables of ticks.");
    return input;
  }
  const std::vector<Table> tables = choose_tables(found, input);
  read_lines(tables, input);
  try {
    read_view(found, tables, folder, hints, input);
  } catch (const std::runtime_error& e) {  // Failure and ConfigError
    if (!hints.scene.empty() || !hints.poses.empty()) throw;
    input.notes.push_back(std::string("No 3D view: ") + e.what() + ".");
  }
  return input;
}

}  // namespace palpate::cli
