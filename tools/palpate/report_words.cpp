// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_words.hpp"

#include <algorithm>
#include <cmath>

#include "tools/palpate/report_frames.hpp"
#include "tools/palpate/sweep_figures.hpp"
#include "tools/palpate/words.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::cli {
namespace {

using Words = std::vector<std::string>;

std::string percent(double share) { return format("%.3g %%", 100 * share); }

/// Plain decimals from micrometres up; what is below or far above, as a power of ten.
std::string length(double metres) {
  const double mm = metres * 1e3;
  return mm == 0 || (mm >= 1e-3 && mm < 1e4) ? format("%.3g mm", mm) : format("%.2e m", metres);
}

std::string time_of(double us) {
  return std::isnan(us) ? "not timed" : duration(static_cast<std::uint64_t>(us * 1e3));
}

std::string full_name(const SweepPoint& p) { return p.engine + " (" + p.words + ")"; }

template <class Value>
double quantile_of(const std::vector<TickRow>& ticks, double share, Value value) {
  std::vector<double> values;
  values.reserve(ticks.size());
  for (const TickRow& row : ticks) values.push_back(value(row));
  return quantile(std::move(values), share);
}

double microseconds_of(const TickRow& row) {
  return row.time_ns == 0 ? std::nan("") : static_cast<double>(row.time_ns) * 1e-3;
}

// Sweeps.

const SweepPoint* fastest_within(const std::vector<SweepPoint>& points, double nrmse) {
  const SweepPoint* best = nullptr;
  for (const SweepPoint& p : points) {
    if (p.exact || !(p.force_nrmse <= nrmse) || std::isnan(p.median_us)) continue;
    if (best == nullptr || p.median_us < best->median_us) best = &p;
  }
  return best;
}

std::string trade(const SweepPoint& p) {
  std::string out = time_of(p.median_us) + " at the median and " + time_of(p.p999_us) + " at p99.9";
  if (!std::isnan(p.speedup))
    out += format(", %.3g times as fast as the paper's exact query", p.speedup);
  return out + "; a hand could notice its error in " + percent(p.noticeable) + " of the ticks";
}

Words sweep_words(const std::vector<SweepPoint>& points) {
  Words out;
  const auto front =
      std::count_if(points.begin(), points.end(), [](const SweepPoint& p) { return p.pareto; });
  out.push_back(count_of(points.size(), "setting", "settings") + " on the same motion; " +
                grouped(std::size_t(front)) +
                " of them are best trades: none other is both faster and more accurate.");
  for (const SweepPoint& p : points) {
    if (p.exact) {
      out.push_back("The exact query of " + full_name(p) + " takes " + time_of(p.median_us) +
                    " at the median, " + time_of(p.p999_us) + " at p99.9.");
    }
  }
  for (const double nrmse : {0.01, 0.05, 0.2}) {
    const SweepPoint* p = fastest_within(points, nrmse);
    if (p == nullptr) {
      out.push_back("No setting but the exact ones keeps the error of the force within " +
                    percent(nrmse) + ".");
    } else {
      out.push_back("Fastest with an error of the force within " + percent(nrmse) + ": " +
                    full_name(*p) + ", error " + percent(p->force_nrmse) + ", " + trade(*p) + ".");
    }
  }
  std::uint64_t broken = 0;
  for (const SweepPoint& p : points) broken += p.certificates_broken;
  out.push_back(broken == 0 ? "No certificate was broken."
                            : count_of(broken, "certificate was", "certificates were") +
                                  " broken: the true distance lay outside the bound.");
  return out;
}

// Replays and runs.

std::string times(const ReportLine& line) {
  const auto at = [&](double share) {
    return time_of(quantile_of(line.ticks, share, microseconds_of));
  };
  if (at(1.0) == time_of(std::nan(""))) return "was not timed";
  return "took " + at(0.5) + " at the median, " + at(0.99) + " at p99, " + at(0.999) +
         " at p99.9, " + at(1.0) + " at most";
}

std::string touch(const ReportLine& line) {
  std::size_t touching = 0, cut = 0;
  double most_N = 0, sum_N = 0;
  for (const TickRow& row : line.ticks) {
    const double force_N = norm(row.wrench.force_N);
    sum_N += force_N;
    most_N = std::max(most_N, force_N);
    if (row.contacts > 0) ++touching;
    if (row.certificate.truncated()) ++cut;
  }
  const auto ticks = static_cast<double>(line.ticks.size());
  return "The tool was in contact in " + percent(double(touching) / ticks) +
         " of the ticks; force " +
         format("%.3g N on average, %.3g N at most", sum_N / ticks, most_N) + ". " +
         (cut == 0 ? "All ticks are exact."
                   : count_of(cut, "tick", "ticks") + " (" + percent(double(cut) / ticks) + ") " +
                         (cut == 1 ? "is" : "are") + " not proved exact.");
}

std::string breaches(const ReportLine& line, const ReportLine& exact, const JudgedBy& by) {
  std::uint64_t broken = 0;
  for (std::size_t i = 0; i < line.ticks.size(); ++i) {
    const double truth_m = exact.ticks[i].min_distance_m;
    if (certificate_broken(line.ticks[i], truth_m, by.delta_m, by.radius_m)) ++broken;
  }
  return broken == 0 ? " It was never broken."
                     : " It was broken in " + count_of(broken, "tick", "ticks") +
                           ": the true distance lay outside the bound.";
}

std::string certificate(const ReportLine& line, const ReportLine* exact,
                        const std::optional<JudgedBy>& judged) {
  std::string out =
      "the certificate says that the least distance is within " +
      length(quantile_of(line.ticks, 0.5,
                         [](const TickRow& row) { return row.certificate.error_bound_m; })) +
      " of the truth at the median";
  if (exact != nullptr) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < line.ticks.size(); ++i) {
      errors.push_back(distance_error_m(line.ticks[i], exact->ticks[i]));
    }
    const double error_m = quantile(std::move(errors), 0.5);
    if (!std::isnan(error_m)) {
      out +=
          "; the true error against " + exact->name + " is " + length(error_m) + " at the median";
    }
  }
  return out + "." + (exact != nullptr && judged ? breaches(line, *exact, *judged) : "");
}

Words line_words(const ReportInput& input) {
  const auto exact = std::find_if(input.lines.begin(), input.lines.end(),
                                  [](const ReportLine& line) { return line.exact; });
  Words out;
  for (const ReportLine& line : input.lines) {
    out.push_back(line.name + ": a tick " + times(line) + ". " + touch(line));
    if (line.exact) continue;
    out.push_back(line.name + ": " +
                  certificate(line, exact == input.lines.end() ? nullptr : &*exact, input.judged));
  }
  return out;
}

std::string faults(std::uint16_t bits) {
  std::string out;
  for (const std::string_view name : realtime::names({bits})) {
    out += (out.empty() ? "Faults: " : ", ") + std::string(name);
  }
  return out.empty() ? "No fault." : out + ".";
}

Words run_words(const ReportInput& input) {
  const ReportRun& run = *input.run;
  const std::vector<TickRow>& ticks = input.lines.front().ticks;
  Words out;
  out.push_back(count_of(ticks.size(), "tick", "ticks") +
                format(" at %.6g Hz, %.3g s; ", run.rate_Hz, ticks.back().t_s - ticks.front().t_s) +
                count_of(run.missed, "period was", "periods were") + " missed, " +
                count_of(run.dropped, "tick", "ticks") + " left no record.");
  std::vector<double> late_us;
  for (const std::uint32_t ns : run.latency_ns) late_us.push_back(double(ns) * 1e-3);
  out.push_back("The host woke the loop " + time_of(quantile(late_us, 0.5)) +
                " late at the median, " + time_of(quantile(late_us, 0.999)) + " at p99.9, " +
                time_of(quantile(late_us, 1.0)) + " at most.");
  out.push_back(format("The device was sent %.3g N at most. ", run.sent_force_max_N) +
                faults(run.faults));
  for (std::string& words : line_words(input)) out.push_back(std::move(words));
  return out;
}

}  // namespace

std::vector<std::string> summary_in_words(const ReportInput& input) {
  if (input.kind == ReportKind::sweep) return sweep_words(input.settings);
  if (input.kind == ReportKind::run) return run_words(input);
  Words out = {count_of(input.lines.front().ticks.size(), "tick", "ticks") + " replayed, " +
               count_of(input.lines.size(), "table", "tables") + "."};
  for (std::string& words : line_words(input)) out.push_back(std::move(words));
  return out;
}

}  // namespace palpate::cli
