// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/report_support.hpp"

namespace palpate::cli {
namespace {

using nlohmann::json;

json example() { return json::parse(test::read_file(PALPATE_TEST_DATA "/sweep.json")); }

class ReportSweep : public ::testing::Test {
 protected:
  std::vector<SweepPoint> read(const json& list) {
    return read_sweep(folder_.write("sweep.json", list.dump()));
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReportSweep, settings_keep_their_figures_in_the_units_of_the_names) {
  const json list = example();
  const std::vector<SweepPoint> points = read(list);
  ASSERT_EQ(points.size(), list.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].id, list[i].at("id"));
    EXPECT_EQ(points[i].exact, list[i].at("exact"));
    EXPECT_DOUBLE_EQ(points[i].median_us, list[i].at("median_ns").get<double>() / 1000);
    EXPECT_EQ(points[i].force_nrmse, list[i].at("force_nrmse"));
    EXPECT_EQ(points[i].pareto, list[i].at("pareto"));
  }
}

TEST_F(ReportSweep, null_is_no_figure) {
  json list = example();
  list[0]["speedup_median"] = nullptr;
  EXPECT_TRUE(std::isnan(read(list)[0].speedup));
}

TEST_F(ReportSweep, words_name_what_is_set_and_nothing_else) {
  const std::vector<SweepPoint> points = read(example());
  EXPECT_EQ(points[0].words, "exact, delta 0.5 mm");
  EXPECT_EQ(points[1].words, "exact, paper's bounds, delta 0.5 mm");
  EXPECT_EQ(points[3].words, "s0 0.5 %, delta 0.5 mm");
  EXPECT_EQ(points.back().words, "force tolerance 0.02 N, budget 100 µs, delta 0.5 mm");
}

TEST_F(ReportSweep, keys_beyond_the_contract_may_be_absent) {
  json list = example();
  for (const char* key : {"id", "pareto", "certificates_broken"}) list[1].erase(key);
  const SweepPoint point = read(list)[1];
  EXPECT_EQ(point.id, "1");
  EXPECT_FALSE(point.pareto);
}

TEST_F(ReportSweep, each_missing_or_mistyped_key_is_refused_by_name_and_place) {
  for (const char* key : {"engine",
                          "exact",
                          "s0",
                          "kappa",
                          "budget_us",
                          "bounds",
                          "delta_m",
                          "median_ns",
                          "p99_ns",
                          "p999_ns",
                          "max_ns",
                          "front_mean",
                          "queries_mean",
                          "truncated",
                          "force_nrmse",
                          "torque_nrmse",
                          "noticeable",
                          "error_bound_median",
                          "true_error_median",
                          "speedup_median"}) {
    for (const bool missing : {true, false}) {
      json list = example();
      constexpr std::size_t kLevels = 3;  // has every key that levels have
      if (missing) {
        list[kLevels].erase(key);
      } else {
        list[kLevels][key] = json::array();
      }
      const std::string said = test::failure_of([&] { (void)read(list); });
      EXPECT_NE(said.find("'" + std::string(key) + "'"), std::string::npos) << key << ": " << said;
      EXPECT_NE(said.find("sweep.json, setting 3"), std::string::npos) << said;
    }
  }
}

TEST_F(ReportSweep, what_is_no_list_of_settings_is_refused) {
  for (const char* text : {"", "{}", "[]", "[1]", "[{]", "null"}) {
    const auto file = folder_.write("sweep.json", text);
    EXPECT_NE(test::failure_of([&] { (void)read_sweep(file); }), "") << text;
  }
  EXPECT_NE(test::failure_of([&] { (void)read_sweep(folder_.path() / "none"); }), "");
}

}  // namespace
}  // namespace palpate::cli
