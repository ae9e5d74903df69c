// SPDX-License-Identifier: GPL-3.0-or-later
// Reports from folders: files are told apart by their first lines, not by their names.
#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/report_input.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

/// Files of each kind, by name.
struct Found {
  std::vector<fs::path> ticks, contacts, poses, scenes;
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
  for (auto* files : {&found.ticks, &found.contacts, &found.poses, &found.scenes}) {
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

/// Exact lines first, then those of the Pareto front, then the others: the first of them are shown.
std::vector<ReportLine> name_lines(const Found& found, const std::vector<SweepPoint>& settings) {
  std::vector<std::pair<int, ReportLine>> ranked;
  for (const fs::path& file : found.ticks) {
    ReportLine line;
    line.name = file.stem().string();
    const auto point = std::find_if(settings.begin(), settings.end(),
                                    [&](const SweepPoint& p) { return p.id == line.name; });
    line.exact = point != settings.end() ? point->exact : line.name.starts_with("exact");
    const bool front = point != settings.end() && point->pareto;
    const int rank = line.exact ? 0 : front ? 1 : 2;
    ranked.emplace_back(rank, std::move(line));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ReportLine> lines;
  for (auto& [rank, line] : ranked) lines.push_back(std::move(line));
  return lines;
}

void read_lines(const Found& found, ReportInput& out) {
  out.lines = name_lines(found, out.settings);
  if (out.lines.size() > kMaxReportLines) {
    out.notes.push_back("Profiles show " + std::to_string(kMaxReportLines) + " of " +
                        std::to_string(out.lines.size()) +
                        " tables: exact ones first, then the best trades.");
    out.lines.resize(kMaxReportLines);
  }
  for (ReportLine& line : out.lines) {
    const auto file =
        std::find_if(found.ticks.begin(), found.ticks.end(),
                     [&](const fs::path& candidate) { return candidate.stem() == line.name; });
    line.ticks = read_ticks(*file);
    if (line.ticks.size() != out.lines.front().ticks.size()) {
      throw Failure(kRefused, "tables of different lengths in one folder", file->string(),
                    "give each motion a folder of its own");
    }
  }
}

/// What a sweep says of itself; an empty object where there is no such file.
nlohmann::json about(const fs::path& folder) {
  std::string text;
  if (config::read_text(folder / "about.json", text)) return nlohmann::json::object();
  auto json = nlohmann::json::parse(text, nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

/// What the command line names, else what the sweep was made from, else the folder's only one.
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

/// Contacts of a line that is not exact before those of one that is: they are chosen levels.
void pair_contacts(const Found& found, const std::vector<ReportLine>& lines, ReportScene& out) {
  for (const bool exact : {false, true}) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].exact != exact) continue;
      for (const fs::path& file : found.contacts) {
        const bool only = found.contacts.size() == 1 && lines.size() == 1;
        if (!only && base_of(file.stem()) != base_of(lines[i].name)) continue;
        out.contacts = file;
        out.contacts_of = i;
        return;
      }
    }
  }
}

void read_view(const Found& found, const fs::path& folder, const ReportHints& hints,
               ReportInput& out) {
  const nlohmann::json json = about(folder);
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
  pair_contacts(found, out.lines, view);
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
  read_lines(found, input);
  try {
    read_view(found, folder, hints, input);
  } catch (const std::runtime_error& e) {  // Failure and ConfigError
    if (!hints.scene.empty() || !hints.poses.empty()) throw;
    input.notes.push_back(std::string("No 3D view: ") + e.what() + ".");
  }
  return input;
}

}  // namespace palpate::cli
