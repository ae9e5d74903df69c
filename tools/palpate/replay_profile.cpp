// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/replay_profile.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace palpate::cli {
namespace {

constexpr const char* kStageNames[kStages] = {"start", "refine", "upkeep", "settle", "force"};

struct Count {
  const char* name;
  std::uint64_t Counters::*value;
};
constexpr Count kCounts[] = {{"own_queries", &Counters::own_queries},
                             {"culling_queries", &Counters::culling_queries},
                             {"part_queries", &Counters::part_queries},
                             {"iterations", &Counters::iterations},
                             {"warm_queries", &Counters::warm_queries},
                             {"splits", &Counters::splits},
                             {"near_regions", &Counters::near_regions},
                             {"searches", &Counters::searches},
                             {"sweeps", &Counters::sweeps}};

struct HighWater {
  const char* name;
  std::uint32_t Counters::*value;
  std::uint32_t Limits::*room;
};
constexpr HighWater kHighWaters[] = {
    {"most_nodes", &Counters::most_nodes, &Limits::nodes},
    {"most_waiting", &Counters::most_waiting, &Limits::nodes},
    {"most_contacts", &Counters::most_contacts, &Limits::contacts}};

}  // namespace

std::string profile_text(const Counters& counters, const Limits& limits) {
  const double ticks = counters.ticks > 0 ? double(counters.ticks) : 1.0;
  std::string text;
  char line[96];
  for (std::uint32_t i = 0; i < kStages; ++i) {
    std::snprintf(line, sizeof line, "%-16s %12.2f µs a tick\n", kStageNames[i],
                  double(counters.stage_ns[i]) * 1e-3 / ticks);
    text += line;
  }
  for (const Count& count : kCounts) {
    std::snprintf(line, sizeof line, "%-16s %12.1f a tick\n", count.name,
                  double(counters.*count.value) / ticks);
    text += line;
  }
  for (const HighWater& mark : kHighWaters) {
    std::snprintf(line, sizeof line, "%-16s %12u of %u\n", mark.name, counters.*mark.value,
                  limits.*mark.room);
    text += line;
  }
  return text;
}

nlohmann::ordered_json profile_json(const Counters& counters) {
  nlohmann::ordered_json json = {{"ticks", counters.ticks}};
  for (std::uint32_t i = 0; i < kStages; ++i) {
    json["stage_ns"][kStageNames[i]] = counters.stage_ns[i];
  }
  for (const Count& count : kCounts) json[count.name] = counters.*count.value;
  for (const HighWater& mark : kHighWaters) json[mark.name] = counters.*mark.value;
  return json;
}

}  // namespace palpate::cli
