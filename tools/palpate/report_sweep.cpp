// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_sweep.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

using nlohmann::json;

constexpr const char* kFixSweep = "give the sweep.json that 'palpate sweep' wrote";

/// The figures of one setting by name; says where what is missing.
class SettingRow {
 public:
  SettingRow(const json& row, std::string where) : row_(row), where_(std::move(where)) {
    if (!row_.is_object()) throw Failure(kRefused, "a setting is no object", where_, kFixSweep);
  }

  /// null is NaN.
  [[nodiscard]] double number(const char* key) const {
    const json& value = at(key);
    if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value.is_number()) refuse(key, "a number or null");
    return value.get<double>();
  }
  [[nodiscard]] bool flag(const char* key) const {
    const json& value = at(key);
    if (!value.is_boolean()) refuse(key, "true or false");
    return value.get<bool>();
  }
  [[nodiscard]] std::string text(const char* key) const {
    const json& value = at(key);
    if (!value.is_string()) refuse(key, "a string");
    return value.get<std::string>();
  }
  [[nodiscard]] const json& at(const char* key) const {
    const auto found = row_.find(key);
    if (found == row_.end()) {
      throw Failure(kRefused, std::string("no '") + key + "'", where_, kFixSweep);
    }
    return *found;
  }
  [[nodiscard]] bool has(const char* key) const { return row_.contains(key); }

 private:
  [[noreturn]] void refuse(const char* key, const char* wanted) const {
    throw Failure(kRefused, std::string("'") + key + "' is not " + wanted, where_, kFixSweep);
  }

  const json& row_;
  std::string where_;
};

/// Only what is set: a limit that does not hold is null.
std::string words_of(const SettingRow& row, bool levels, bool exact) {
  std::string out = exact ? "exact" : "";
  const auto add = [&out](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  const auto add_number = [&](const char* key, const char* name, double scale, const char* unit) {
    if (!row.at(key).is_null())
      add(std::string(name) + " " + format("%.4g", scale * row.number(key)) + unit);
  };
  if (!exact && levels) {
    add_number("s0", "s0", 100, " %");
    add_number("kappa", "kappa", 1, "");
  }
  if (!exact && !levels) add_number("force_tolerance_N", "force tolerance", 1, " N");
  add_number("budget_us", "budget", 1, " µs");
  if (levels) {
    if (!row.at("bounds").is_null() && row.text("bounds") == "paper") add("paper's bounds");
  }
  add_number("delta_m", "delta", 1e3, " mm");
  return out;
}

SweepPoint point_of(const SettingRow& row, std::size_t place) {
  SweepPoint p;
  p.id = row.has("id") ? row.text("id") : std::to_string(place);
  p.engine = row.text("engine");
  p.exact = row.flag("exact");
  p.words = words_of(row, p.engine == "levels", p.exact);
  p.delta_m = row.number("delta_m");
  p.median_us = row.number("median_ns") * 1e-3;
  p.p99_us = row.number("p99_ns") * 1e-3;
  p.p999_us = row.number("p999_ns") * 1e-3;
  p.max_us = row.number("max_ns") * 1e-3;
  p.front_mean = row.number("front_mean");
  p.queries_mean = row.number("queries_mean");
  p.truncated = row.number("truncated");
  p.force_nrmse = row.number("force_nrmse");
  p.torque_nrmse = row.number("torque_nrmse");
  p.noticeable = row.number("noticeable");
  p.bound_m = row.number("error_bound_median");
  p.error_m = row.number("true_error_median");
  p.speedup = row.number("speedup_median");
  p.pareto = row.has("pareto") && row.flag("pareto");
  p.certificates_broken =
      row.has("certificates_broken") ? std::uint64_t(row.number("certificates_broken")) : 0;
  return p;
}

}  // namespace

std::vector<SweepPoint> read_sweep(const std::filesystem::path& file) {
  std::string text;
  if (const std::error_code error = config::read_text(file, text)) {
    throw Failure(kRefused, "cannot read the sweep (" + error.message() + ")", file.string(),
                  kFixSweep);
  }
  const json list = json::parse(text, nullptr, false);
  if (!list.is_array() || list.empty()) {
    throw Failure(kRefused, "not a list of settings", file.string(), kFixSweep);
  }
  std::vector<SweepPoint> points;
  for (const json& row : list) {
    const std::string where = file.string() + ", setting " + std::to_string(points.size());
    points.push_back(point_of(SettingRow(row, where), points.size()));
  }
  return points;
}

}  // namespace palpate::cli
