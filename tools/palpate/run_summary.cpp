// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "tools/palpate/fault_words.hpp"
#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

using realtime::Histogram;
using realtime::LoopReport;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

double mean(double sum, std::uint64_t count) {
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

std::uint64_t page_faults(const LoopReport& r) {
  return r.counted.minor_faults + r.counted.major_faults;
}

std::string line(const char* label, const std::string& text) {
  return format("  %-16s ", label) + text + "\n";
}

std::string percentiles(const Histogram& h) {
  return "p50 " + duration(h.percentile_ns(0.5)) + ", p99 " + duration(h.percentile_ns(0.99)) +
         ", p99.9 " + duration(h.percentile_ns(0.999)) + ", max " + duration(h.max_ns());
}

/// A bar as long as its share of the fullest row; what is there at all shows.
std::string bar(std::uint64_t count, std::uint64_t fullest) {
  constexpr double kWidth = 22;
  if (count == 0) return "";
  const auto length = static_cast<std::size_t>(std::ceil(kWidth * share(count, fullest)));
  return std::string(length, '#');
}

/// Both histograms side by side, a row for each doubling of the time.
std::string histograms(const LoopReport& r) {
  constexpr int kFirstBit = 10, kLastBit = 40;  // rows from about 1 us to about 18 minutes
  struct Row {
    std::uint64_t from_ns, to_ns, latency, tick;
  };
  std::vector<Row> rows;
  std::uint64_t fullest = 1;
  for (int bit = kFirstBit; bit <= kLastBit; ++bit) {
    Row row{};
    row.from_ns = bit == kFirstBit ? 0 : std::uint64_t(1) << (bit - 1);
    row.to_ns = std::uint64_t(1) << bit;
    row.latency = r.latency.count_between(row.from_ns, row.to_ns);
    row.tick = r.tick.count_between(row.from_ns, row.to_ns);
    fullest = std::max({fullest, row.latency, row.tick});
    rows.push_back(row);
  }
  const auto filled = [](const Row& row) { return row.latency + row.tick > 0; };
  const auto first = std::find_if(rows.begin(), rows.end(), filled);
  const auto last = std::find_if(rows.rbegin(), rows.rend(), filled).base();

  std::string text = format("\n  %9s    %-32s  %s\n", "below", "wake-up lateness", "tick time");
  for (auto row = first; row < last; ++row) {
    text += "  " + right_aligned(duration(row->to_ns), 9) +
            format("  %9s %-22s %9s", grouped(row->latency).c_str(),
                   bar(row->latency, fullest).c_str(), grouped(row->tick).c_str());
    text += (row->tick > 0 ? " " : "") + bar(row->tick, fullest) + "\n";
  }
  return text + "\n";
}

std::string timing_lines(const LoopReport& r) {
  std::string deadlines =
      grouped(r.ticks + r.missed) + " periods, " + grouped(r.missed) + " missed";
  if (r.missed > 0) {
    deadlines += format(" (%.3f %%)", 100 * share(r.missed, r.ticks + r.missed)) +
                 ", latest command " + duration(r.overrun_ns_max) + " after its period";
  }
  std::string felt;
  if (r.missed > 0 && r.force_N_max > 0) {
    felt = line("", "meanwhile the last force stays: a hand feels a knock, or a ringing");
  }
  return line("deadlines", deadlines) + felt + line("wake-up lateness", percentiles(r.latency)) +
         line("tick time", percentiles(r.tick)) +
         line("age of readings", percentiles(r.state_age)) + histograms(r);
}

std::string not_exact(const LoopReport& r) {
  std::string text = format("%.1f %% of the ticks", 100 * share(r.truncated, r.queried));
  if (r.on_reserve > 0) {
    text += "; " + grouped(r.on_reserve) + " went on to see whether anything touches";
  }
  return text;
}

std::string contact_lines(const LoopReport& r) {
  return line("contacts",
              format("%.1f a tick; touching in %.1f %% of the ticks, undecided in %.1f %%",
                     mean(static_cast<double>(r.contacts), r.queried),
                     100 * share(r.touching, r.queried), 100 * share(r.undecided, r.queried))) +
         line("force", format("mean %.3f N, max %.3f N; torque max %.4f N m",
                              mean(r.force_N_sum, r.ticks), r.force_N_max, r.torque_Nm_max)) +
         line("energy", format("hand to scene %.2e J, never below %.2e J", r.energy_J + 0.0,
                               r.energy_J_min + 0.0)) +
         line("not exact", not_exact(r));
}

std::string host_lines(const RunOutcome& o) {
  const auto& calls = o.report.counted.allocator_calls;
  std::string text =
      line("allocations", calls ? grouped(*calls) + " in the loop" : "not counted in this build") +
      line("page faults", grouped(page_faults(o.report)) + " in the loop") +
      line("scheduler",
           o.grant.scheduler + (o.grant.memory_locked ? ", memory locked" : ", memory not locked"));
  if (o.contacts_late) {
    text += line("contact thread", grouped(*o.contacts_late) + " queries ended late");
  }
  if (o.trace) {
    text +=
        line("trace", o.trace->string() + ", " + grouped(o.telemetry_dropped) + " ticks dropped");
  }
  for (const std::string& note : o.grant.notes) text += line("note", note);
  return text;
}

std::string fault_lines(const LoopReport& r) {
  std::string text;
  for (const FaultNote& note : fault_notes(r)) {
    text += line(note.fault.empty() ? "note" : "fault",
                 "in tick " + grouped(note.tick) + ": " + note.cause +
                     (note.device.empty() ? "" : " (" + note.device + ")")) +
            line("fix", note.fix);
  }
  return text;
}

std::string verdict(const RunOutcome& o) {
  const auto broken = broken_promises(o);
  const bool faulted = !o.report.faults.empty();
  if (broken.empty()) {
    return faulted ? "\nA fault has ended the rendering.\n" : "\nEvery promise was kept.\n";
  }
  std::string text = "\nPromises broken: ";
  for (std::size_t i = 0; i < broken.size(); ++i) text += (i > 0 ? ", " : "") + broken[i];
  return text + ". `palpate doctor` says what this host lacks.\n";
}

nlohmann::json fault_json(const LoopReport& r) {
  nlohmann::json list = nlohmann::json::array();
  for (const FaultNote& note : fault_notes(r)) {
    list.push_back({{"fault", note.fault},
                    {"device", note.device},
                    {"tick", note.tick},
                    {"cause", note.cause},
                    {"fix", note.fix}});
  }
  return list;
}

nlohmann::json percentiles_json(const Histogram& h) {
  return {{"p50", h.percentile_ns(0.5)},
          {"p99", h.percentile_ns(0.99)},
          {"p999", h.percentile_ns(0.999)},
          {"max", h.max_ns()}};
}

}  // namespace

std::vector<std::string> broken_promises(const RunOutcome& o) {
  std::vector<std::string> broken;
  const LoopReport& r = o.report;
  if (r.missed > 0) broken.push_back(count_of(r.missed, "deadline", "deadlines") + " missed");
  const std::uint64_t calls = r.counted.allocator_calls.value_or(0);
  if (calls > 0) broken.push_back(count_of(calls, "allocator call", "allocator calls"));
  if (page_faults(r) > 0) {
    broken.push_back(count_of(page_faults(r), "page fault", "page faults"));
  }
  return broken;
}

std::string run_text(const RunOutcome& o) {
  const LoopReport& r = o.report;
  const double seconds = static_cast<double>(r.ticks + r.missed) / o.rate_Hz;
  std::string text =
      o.scene.filename().string() + " on the " + o.device + " device, " +
      format("%.1f s at %.0f Hz, ", seconds, o.rate_Hz) +
      (o.budget_us ? format("budget %.0f µs\n\n", *o.budget_us) : "no budget but the period\n\n");
  std::string state(realtime::name(r.state));
  for (const std::string_view fault : realtime::names(r.faults)) state += " " + std::string(fault);
  return text + line("state", state) + fault_lines(r) + timing_lines(r) + contact_lines(r) +
         host_lines(o) + verdict(o);
}

nlohmann::json run_json(const RunOutcome& o) {
  const LoopReport& r = o.report;
  nlohmann::json j;
  j["scene"] = o.scene.string();
  j["device"] = o.device;
  j["ticks"] = r.ticks;
  j["rate_hz"] = o.rate_Hz;
  j["budget_us"] = o.budget_us ? nlohmann::json(*o.budget_us) : nlohmann::json();
  j["homing"] = r.homing;
  j["missed"] = r.missed;
  j["overrun_ns_max"] = r.overrun_ns_max;
  j["latency_ns"] = percentiles_json(r.latency);
  j["tick_ns"] = percentiles_json(r.tick);
  j["state_age_ns"] = percentiles_json(r.state_age);
  const auto& calls = r.counted.allocator_calls;
  j["allocations"] = calls ? nlohmann::json(*calls) : nlohmann::json();
  j["page_faults"] = page_faults(r);
  j["page_faults_major"] = r.counted.major_faults;
  j["contacts_late"] = o.contacts_late ? nlohmann::json(*o.contacts_late) : nlohmann::json();
  j["truncated"] = r.truncated;
  j["touching"] = r.touching;
  j["undecided"] = r.undecided;
  j["on_reserve"] = r.on_reserve;
  j["contacts_mean"] = mean(static_cast<double>(r.contacts), r.queried);
  j["force_N"] = {{"mean", mean(r.force_N_sum, r.ticks)}, {"max", r.force_N_max}};
  j["torque_Nm"] = {{"max", r.torque_Nm_max}};
  j["energy_J"] = r.energy_J;
  j["energy_J_min"] = r.energy_J_min;
  j["state"] = realtime::name(r.state);
  j["faults"] = realtime::names(r.faults);
  j["device_faults"] = device_fault_names(r.device_faults);
  j["fault_details"] = fault_json(r);
  j["scheduler"] = o.grant.scheduler;
  j["memory_locked"] = o.grant.memory_locked;
  j["notes"] = o.grant.notes;
  j["trace"] = o.trace ? nlohmann::json(o.trace->string()) : nlohmann::json();
  j["telemetry_dropped"] = o.telemetry_dropped;
  return j;
}

}  // namespace palpate::cli
