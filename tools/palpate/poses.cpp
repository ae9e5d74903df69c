// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/poses.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>

#include "config/scene_keys.hpp"
#include "config/text_file.hpp"
#include "config/unit_quaternion.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

constexpr std::size_t kFields = 9;
constexpr std::array<std::string_view, kFields> kNames = {"t",  "body", "px", "py", "pz",
                                                          "qw", "qx",   "qy", "qz"};

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, const config::Scene& scene)
      : file_(file.string()), scene_(scene), last_tick_of_(scene.bodies.size(), 0) {}

  PoseTrack read(std::string_view text) {
    bool have_header = false;
    while (!text.empty()) {
      ++line_;
      const std::size_t end = text.find('\n');
      std::string_view row = text.substr(0, end);
      text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
      if (row.ends_with('\r')) row.remove_suffix(1);
      if (have_header) {
        if (!without_blanks(row).empty()) add(row);
      } else {
        if (row != kPosesHeader)
          refuse("another header", "the first line has to be " + std::string(kPosesHeader));
        have_header = true;
      }
    }
    if (track_.ticks.empty()) refuse("no poses", "give one row or more below the header");
    return std::move(track_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& fix) const {
    throw Failure(kRefused, what, file_ + ":" + std::to_string(line_), fix);
  }

  void add(std::string_view row) {
    std::array<std::string_view, kFields> fields;
    split(row, fields);
    const double t_s = number(fields, 0);
    if (track_.ticks.empty() || t_s != track_.ticks.back().t_s) start_tick(t_s);

    PoseChange change;
    change.body = body(fields[1]);
    change.pose.position_m = {coordinate(fields, 2), coordinate(fields, 3), coordinate(fields, 4)};
    Quat& q = change.pose.orientation;
    q = {number(fields, 5), number(fields, 6), number(fields, 7), number(fields, 8)};
    if (!config::make_unit(q)) {
      refuse("not a unit quaternion",
             "give qw,qx,qy,qz of length 1 within " + config::to_text(config::kUnitTolerance));
    }
    if (last_tick_of_[change.body] == track_.ticks.size()) {
      refuse("body '" + std::string(without_blanks(fields[1])) + "' a second time at one t",
             "give one row a body and time");
    }
    last_tick_of_[change.body] = track_.ticks.size();
    track_.changes.push_back(change);
    ++track_.ticks.back().changes;
  }

  void start_tick(double t_s) {
    if (!track_.ticks.empty() && t_s < track_.ticks.back().t_s) {
      refuse("time runs backwards", "order the rows by t");
    }
    track_.ticks.push_back({t_s, track_.changes.size(), 0});
  }

  void split(std::string_view row, std::array<std::string_view, kFields>& out) const {
    std::size_t count = 0;
    for (;; ++count) {
      const std::size_t comma = row.find(',');
      if (count < kFields) out[count] = row.substr(0, comma);
      if (comma == std::string_view::npos) break;
      row = row.substr(comma + 1);
    }
    if (count + 1 != kFields) {
      refuse(std::to_string(count + 1) + " fields",
             "give " + std::to_string(kFields) + ": " + std::string(kPosesHeader));
    }
  }

  [[nodiscard]] double number(const std::array<std::string_view, kFields>& fields,
                              std::size_t i) const {
    const std::string_view text = without_blanks(fields[i]);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = end == text.data() + text.size();
    if (error == std::errc::invalid_argument || !whole) {
      refuse(std::string(kNames[i]) + " = '" + std::string(text) + "' is no number",
             "give a decimal number");
    }
    if (error != std::errc() || !std::isfinite(value)) {
      refuse(std::string(kNames[i]) + " = " + std::string(text) + " is not finite",
             "give a finite number");
    }
    return value;
  }

  [[nodiscard]] double coordinate(const std::array<std::string_view, kFields>& fields,
                                  std::size_t i) const {
    const double value = number(fields, i);
    if (std::abs(value) > config::kMaxPosition_m) {
      refuse(std::string(kNames[i]) + " = " + config::to_text(value) + " is out of range",
             "give metres from -" + config::to_text(config::kMaxPosition_m) + " to " +
                 config::to_text(config::kMaxPosition_m));
    }
    return value;
  }

  [[nodiscard]] std::uint32_t body(std::string_view field) const {
    const std::string_view name = without_blanks(field);
    for (std::uint32_t i = 0; i < scene_.bodies.size(); ++i) {
      if (scene_.bodies[i].name != name) continue;
      if (scene_.bodies[i].role == config::Role::fixed) {
        refuse("body '" + std::string(name) + "' is fixed",
               "give it role = \"moved\" in " + scene_.file.string());
      }
      return i;
    }
    refuse("no body is named '" + std::string(name) + "'",
           "use the names of " + scene_.file.string());
  }

  std::string file_;
  const config::Scene& scene_;
  std::vector<std::size_t>
      last_tick_of_;  // [bodies] number of the last tick with a row of it, counted from 1
  std::size_t line_ = 0;
  PoseTrack track_;
};

}  // namespace

void PoseTrack::apply(std::size_t tick, std::span<Pose> poses) const {
  const PoseTick& at = ticks[tick];
  for (std::size_t i = at.first; i < at.first + at.changes; ++i)
    poses[changes[i].body] = changes[i].pose;
}

PoseTrack read_poses(const std::filesystem::path& file, const config::Scene& scene) {
  std::string text;
  if (const std::error_code error = config::read_text(file, text)) {
    throw Failure(kRefused, "cannot read the poses (" + error.message() + ")", file.string(),
                  "give a pose file that exists and is readable");
  }
  return Reader(file, scene).read(text);
}

std::string pose_row(double t_s, const std::string& body, const Pose& pose) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", t_s);
  std::string row = std::string(text) + "," + body;
  const Vec3d p = pose.position_m;
  const Quat q = pose.orientation;
  for (const double value : {p.x, p.y, p.z, q.w, q.x, q.y, q.z}) {
    row.push_back(',');
    row.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
  return row + "\n";
}

}  // namespace palpate::cli
