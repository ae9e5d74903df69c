// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of a sweep: what is done, and its ticks (docs/SWEEP.md, "Files").
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/replay_csv.hpp"
#include "tools/palpate/sweep_figures.hpp"
#include "tools/palpate/sweep_settings.hpp"

namespace palpate::cli {

/// What a folder's figures are made with, beside settings.
struct SweepMeasures {
  Observer observer;
  bool processor_time = false;  ///< see ReplayOptions
};

class SweepFolder {
 public:
  /// Makes the folder and its about.json, or goes on with one that was made for the same scene,
  /// poses, images and clock. Throws Failure: kUsage where it was made for others or is no such
  /// folder, kRefused where an image is refused, kOther where it cannot be written.
  SweepFolder(std::filesystem::path folder, const config::Scene& scene,
              const std::filesystem::path& poses, std::size_t ticks, const SweepMeasures& measures);

  /// The setting's ticks, where they are there and as many as the track has.
  [[nodiscard]] std::optional<std::vector<TickRow>> load(const SweepSetting& setting) const;

  /// Whole or not at all; replaces what is there.
  void save(const SweepSetting& setting, std::span<const TickRow> ticks) const;

  [[nodiscard]] std::filesystem::path file(const char* name) const { return folder_ / name; }
  [[nodiscard]] double radius_m() const { return radius_m_; }  ///< of the largest body

 private:
  [[nodiscard]] std::filesystem::path ticks_file(const SweepSetting& setting) const;

  std::filesystem::path folder_;
  std::size_t ticks_;
  double radius_m_ = 0;
};

}  // namespace palpate::cli
