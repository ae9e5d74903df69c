// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_contacts.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <span>

#include "tools/palpate/command.hpp"
#include "tools/palpate/replay_loop.hpp"
#include "tools/realtime/contact_force.hpp"

namespace palpate::cli {
namespace {

/// Keeps the contacts of each frame that are felt most. Frames come in order.
class Picker {
 public:
  Picker(const Frames& frames, const Settings& settings)
      : settings_(settings),
        limit_(std::clamp<std::size_t>(kMaxShownContacts / frames.count, 1, kMaxContactsOfFrame)) {
    out_.starts.push_back(0);
  }

  void add(std::span<const Contact> frame) {
    std::vector<Contact> felt(frame.begin(), frame.end());
    const std::size_t shown = std::min(limit_, felt.size());
    std::partial_sort(felt.begin(), felt.begin() + static_cast<std::ptrdiff_t>(shown), felt.end(),
                      [this](const Contact& a, const Contact& b) {
                        return realtime::contact_force(a, settings_) >
                               realtime::contact_force(b, settings_);
                      });
    felt.resize(shown);
    out_.contacts.insert(out_.contacts.end(), felt.begin(), felt.end());
    out_.starts.push_back(static_cast<std::uint32_t>(out_.contacts.size()));
    out_.found.push_back(static_cast<std::uint32_t>(frame.size()));
  }

  ShownContacts finish(std::string origin) {
    out_.origin = std::move(origin);
    return std::move(out_);
  }

 private:
  Settings settings_;
  std::size_t limit_;
  ShownContacts out_;
};

/// CONTACTS.csv, row by row.
class ContactFile {
 public:
  ContactFile(const std::filesystem::path& file, std::size_t pairs)
      : file_(file), pairs_(pairs), in_(file) {
    if (!std::getline(in_, line_) || line_ != kContactsHeader) refuse("not a table of contacts");
    next();
  }

  /// The rows of a tick, which come in the order of the ticks.
  std::span<const Contact> of(std::size_t tick, std::size_t expected) {
    rows_.clear();
    for (; !at_end_ && tick_ == tick; next()) rows_.push_back(contact_);
    if (rows_.size() != expected) {
      refuse("tick " + std::to_string(tick) + " has " + std::to_string(rows_.size()) +
             " contacts here and " + std::to_string(expected) + " in its table of ticks");
    }
    return rows_;
  }

 private:
  static constexpr std::size_t kFields = 17;

  [[noreturn]] void refuse(const std::string& what) const {
    throw Failure(kRefused, what, file_.string() + ":" + std::to_string(number_),
                  "give both tables of one 'palpate replay --contacts'");
  }

  void next() {
    at_end_ = !std::getline(in_, line_);
    ++number_;
    if (!at_end_) parse();
  }

  void parse() {
    std::array<double, kFields> v{};
    const char* at = line_.data();
    const char* const end = at + line_.size();
    for (std::size_t i = 0; i < kFields; ++i) {
      const auto [stopped, error] = std::from_chars(at, end, v[i]);
      const bool last = i + 1 == kFields;
      if (error != std::errc() || (last ? stopped != end : stopped == end || *stopped != ',')) {
        refuse("not a row of contacts");
      }
      at = stopped + 1;
    }
    tick_ = static_cast<std::size_t>(index(v[0], 1e15));
    contact_ = {.point_a_m = {v[2], v[3], v[4]},
                .point_b_m = {v[5], v[6], v[7]},
                .normal = {v[8], v[9], v[10]},
                .distance_m = v[11],
                .weight = v[16],
                .pair = static_cast<std::uint32_t>(index(v[1], double(pairs_) - 1)),
                .piece_a = static_cast<std::uint32_t>(index(v[12], image::kMaxPieces)),
                .level_a = static_cast<std::uint32_t>(index(v[13], image::kMaxLevels)),
                .piece_b = static_cast<std::uint32_t>(index(v[14], image::kMaxPieces)),
                .level_b = static_cast<std::uint32_t>(index(v[15], image::kMaxLevels))};
  }

  [[nodiscard]] double index(double value, double last) const {
    if (!(value >= 0 && value <= last)) refuse("an index out of range");
    return value;
  }

  std::filesystem::path file_;
  std::size_t pairs_;
  std::ifstream in_;
  std::string line_;
  std::size_t number_ = 1;
  bool at_end_ = false;
  std::size_t tick_ = 0;  // of the row that comes next
  Contact contact_;
  std::vector<Contact> rows_;
};

/// The frames' poses as a recording of their own.
PoseTrack track_of_frames(const ReportScene& view, const Frames& frames) {
  std::vector<Pose> poses;
  for (const config::Body& body : view.scene.bodies) poses.push_back(body.pose);
  PoseTrack out;
  for (std::size_t tick = 0; tick < frames.ticks; ++tick) {
    view.track.apply(tick, poses);
    if (tick % frames.stride != 0) continue;
    out.ticks.push_back({view.track.ticks[tick].t_s, out.changes.size(), poses.size()});
    for (std::uint32_t body = 0; body < poses.size(); ++body) {
      out.changes.push_back({body, poses[body]});
    }
  }
  return out;
}

}  // namespace

ShownContacts read_shown_contacts(const ReportScene& view, const ReportLine& line,
                                  const Frames& frames) {
  ContactFile file(view.contacts, view.scene.pairs.size());
  Picker picker(frames, view.scene.settings);
  for (std::size_t tick = 0; tick < frames.ticks; ++tick) {
    const std::span<const Contact> rows = file.of(tick, line.ticks[tick].contacts);
    if (tick % frames.stride == 0) picker.add(rows);
  }
  ShownContacts out =
      picker.finish("Contacts as " + view.contacts.filename().string() + " recorded them.");
  for (std::size_t f = 0; f < frames.count; ++f) {
    out.force_N.push_back(line.ticks[frames.tick(f)].wrench.force_N);
  }
  return out;
}

ShownContacts replay_shown_contacts(const ReportScene& view, const Frames& frames,
                                    const bake::Progress& progress) {
  config::Scene scene = view.scene;
  scene.budget_us.reset();
  Picker picker(frames, scene.settings);
  ReplayListeners listeners;
  if (progress) {
    listeners.progress = [&](double done) { progress("contacts", done); };
  }
  listeners.contacts = [&](std::size_t, std::span<const Contact> found) { picker.add(found); };
  const Recording recording = replay(scene, track_of_frames(view, frames), {}, listeners);
  ShownContacts out =
      picker.finish("Contacts were found again for this report, at the settings of " +
                    scene.file.filename().string() + " and without a time limit.");
  for (const TickRow& row : recording.ticks) out.force_N.push_back(row.wrench.force_N);
  return out;
}

}  // namespace palpate::cli
