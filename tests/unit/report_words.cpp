// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_words.hpp"

#include <gtest/gtest.h>

#include "tests/unit/report_support.hpp"
#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

std::string joined(const ReportInput& input) {
  std::string out;
  for (const std::string& words : summary_in_words(input)) out += words + "\n";
  return out;
}

/// Two lines that are the same but for their names.
ReportInput exact_and_fast() {
  ReportInput input;
  input.lines.resize(2);
  input.lines[0].name = "exact";
  input.lines[0].exact = true;
  input.lines[0].ticks = test::some_ticks(4);
  input.lines[1].name = "fast";
  input.lines[1].ticks = test::some_ticks(4);
  return input;
}

void expect_said(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << words << "\nin\n" << text;
}

TEST(Words, figures_have_the_unit_that_fits) {
  EXPECT_EQ(duration(812), "812 ns");
  EXPECT_EQ(duration(15'140), "15.1 µs");
  EXPECT_EQ(duration(13'420'000), "13.42 ms");
  EXPECT_EQ(grouped(12), "12");
  EXPECT_EQ(grouped(1234567), "1,234,567");
  EXPECT_EQ(count_of(1, "tick", "ticks"), "1 tick");
}

TEST(Words, are_aligned_by_letters_not_by_bytes) {
  EXPECT_EQ(right_aligned("15.1 µs", 9), "  15.1 µs");
  EXPECT_EQ(right_aligned("812 ns", 3), "812 ns");
}

TEST(ReportWords, sweep_names_the_fastest_setting_within_each_error) {
  ReportInput input;
  input.kind = ReportKind::sweep;
  input.settings = read_sweep(PALPATE_TEST_DATA "/sweep.json");
  const std::string text = joined(input);
  expect_said(text, "11 settings on the same motion; 4 of them are best trades");
  expect_said(text, "levels (exact, paper's bounds, delta 0.5 mm) takes 4.20 ms at the median");
  expect_said(text, "within 1 %: regions (force tolerance 0.005 N, delta 0.5 mm), error 0.4 %");
  expect_said(text, "within 5 %: regions (force tolerance 0.02 N, budget 100 µs");
  expect_said(text, "158 times as fast as the paper's exact query");
  expect_said(text, "No certificate was broken.");
}

TEST(ReportWords, sweep_says_what_no_setting_reaches_and_what_broke) {
  ReportInput input;
  input.kind = ReportKind::sweep;
  input.settings = read_sweep(PALPATE_TEST_DATA "/sweep.json");
  std::erase_if(input.settings, [](const SweepPoint& p) { return p.engine == "regions"; });
  input.settings[4].certificates_broken = 2;
  const std::string text = joined(input);
  expect_said(text, "No setting but the exact ones keeps the error of the force within 1 %.");
  expect_said(text, "2 certificates were broken");
}

TEST(ReportWords, replay_says_times_touch_and_certificate) {
  ReportInput input = exact_and_fast();
  input.lines[1].ticks[3].contacts = 2;
  input.lines[1].ticks[3].certificate.truncated_by_time = true;
  for (TickRow& row : input.lines[1].ticks) row.min_distance_m += 1e-5;
  const std::string text = joined(input);
  expect_said(text, "4 ticks replayed, 2 tables.");
  expect_said(text, "fast: a tick took 2.0 µs at the median, 4.0 µs at p99");
  expect_said(text, "in contact in 25 % of the ticks; force 0.15 N on average, 0.3 N at most");
  expect_said(text, "1 tick (25 %) is not proved exact.");
  expect_said(text, "within 0.02 mm of the truth at the median");
  expect_said(text, "the true error against exact is 0.01 mm at the median");
  expect_said(text, "exact: a tick took");
}

TEST(ReportWords, replay_counts_broken_certificates_where_the_scene_is_known) {
  ReportInput input = exact_and_fast();
  EXPECT_EQ(joined(input).find("broken"), std::string::npos);
  input.judged = {.delta_m = 5e-4, .radius_m = 0.01};
  expect_said(joined(input), "It was never broken.");
  input.lines[1].ticks[2].min_distance_m += 4e-5;  // the bound is 3e-5
  expect_said(joined(input), "It was broken in 1 tick: the true distance lay outside the bound.");
}

TEST(ReportWords, run_says_what_was_missed_and_why_it_stopped) {
  ReportInput input;
  input.kind = ReportKind::run;
  input.lines.resize(1);
  input.lines[0].name = "run";
  input.lines[0].ticks = test::some_ticks(4);
  input.run.emplace();
  input.run->rate_Hz = 1000;
  input.run->missed = 1;
  input.run->sent_force_max_N = 0.25;
  input.run->latency_ns = {1000, 2000, 3000, 4000};
  input.run->faults = 1u << 2;
  const std::string text = joined(input);
  expect_said(text, "4 ticks at 1000 Hz, 0.003 s; 1 period was missed, 0 ticks left no record.");
  expect_said(text, "2.0 µs late at the median");
  expect_said(text, "The device was sent 0.25 N at most. Faults: missed_deadlines.");
}

}  // namespace
}  // namespace palpate::cli
