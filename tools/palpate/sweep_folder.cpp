// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_folder.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "config/text_file.hpp"
#include "rt_core/image/sha256.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/image_file.hpp"
#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Failure(kOther, "cannot make the folder (" + error.message() + ")", folder.string(),
                  "give a place that is writable and no file");
  }
}

std::string text_of(const fs::path& file) {
  std::string text;
  if (const std::error_code error = config::read_text(file, text)) {
    throw Failure(kRefused, "cannot read the file (" + error.message() + ")", file.string(),
                  "give a file that exists and is readable");
  }
  return text;
}

/// Hash of everything that the ticks depend on but the settings; reads each image once.
std::string key_of(const config::Scene& scene, const fs::path& poses, bool processor_time,
                   double& out_radius_m) {
  Sha256 hash;
  const std::string clock = processor_time ? "processor" : "real";
  hash.update(std::as_bytes(std::span(clock)));
  for (const fs::path& file : {scene.file, poses}) {
    const std::string text = text_of(file);
    hash.update(std::as_bytes(std::span(text)));
  }
  std::set<fs::path> images;
  for (const config::Body& body : scene.bodies) images.insert(body.image);
  for (const fs::path& file : images) {
    const ImageFile image(file);
    hash.update(std::as_bytes(std::span(image.view().header->content_sha256)));
    out_radius_m = std::max(out_radius_m, image.view().header->radius_m);
  }
  return hex(hash.finish());
}

}  // namespace

SweepFolder::SweepFolder(fs::path folder, const config::Scene& scene, const fs::path& poses,
                         std::size_t ticks, const SweepMeasures& measures)
    : folder_(std::move(folder)), ticks_(ticks) {
  const std::string key = key_of(scene, poses, measures.processor_time, radius_m_);
  make_folder(folder_ / "ticks");
  const fs::path about = file("about.json");
  if (fs::exists(about)) {
    const auto made_for = nlohmann::json::parse(text_of(about), nullptr, false);
    if (made_for.is_object() && made_for.value("key", "") == key) return;
    throw Failure(kUsage, "the folder holds a sweep of another scene, motion, images or clock",
                  folder_.string(), "give another folder, or remove this one");
  }
  const nlohmann::ordered_json json = {{"key", key},
                                       {"scene", fs::absolute(scene.file).string()},
                                       {"poses", fs::absolute(poses).string()},
                                       {"version", PALPATE_VERSION " " PALPATE_BUILD},
                                       {"ticks", ticks},
                                       {"processor_time", measures.processor_time},
                                       {"weber_fraction", measures.observer.weber_fraction},
                                       {"floor_N", measures.observer.floor_N}};
  write_file(about, json.dump(1) + "\n");
}

fs::path SweepFolder::ticks_file(const SweepSetting& setting) const {
  return folder_ / "ticks" / (id_of(setting) + ".csv");
}

std::optional<std::vector<TickRow>> SweepFolder::load(const SweepSetting& setting) const {
  std::string text;
  if (config::read_text(ticks_file(setting), text)) return std::nullopt;
  auto rows = ticks_from_csv(text);
  if (rows && rows->size() != ticks_) rows.reset();
  return rows;
}

void SweepFolder::save(const SweepSetting& setting, std::span<const TickRow> ticks) const {
  write_file(ticks_file(setting), ticks_csv(ticks));
}

}  // namespace palpate::cli
