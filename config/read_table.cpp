// SPDX-License-Identifier: Apache-2.0
#include "config/read_table.hpp"

#include <cctype>
#include <sstream>

namespace palpate::config {
namespace {

/// Least number of letters to insert, remove or replace (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

/// Near enough to be meant: `delta` for `delta_m` (a missing unit), `stifness` for `stiffness` (a
/// slip).
bool near(std::string_view wrong, std::string_view name) {
  if (wrong.size() >= 3 && (name.starts_with(wrong) || wrong.starts_with(name))) return true;
  return edit_distance(wrong, name) <= 1 + name.size() / 4;
}

std::string range(double min, double max) { return to_text(min) + " to " + to_text(max); }

}  // namespace

void refuse(const std::string& what, const std::string& file, const toml::source_region& at,
            const std::string& fix) {
  throw ConfigError(what + ": " + file + ":" + std::to_string(at.begin.line) + ": " + fix);
}

std::string known_names(std::string_view wrong, const std::vector<std::string_view>& names) {
  std::string list;
  std::string_view best;
  std::size_t least = wrong.size() + 64;
  for (const std::string_view name : names) {
    list += (list.empty() ? "" : ", ") + std::string(name);
    const std::size_t d = edit_distance(wrong, name);
    if (d < least && near(wrong, name)) {
      least = d;
      best = name;
    }
  }
  const std::string question = best.empty() ? "" : "did you mean '" + std::string(best) + "'? ";
  return question + "use one of " + list;
}

void Entry::wrong_type(const toml::node& node, const std::string& wanted) const {
  std::ostringstream type;
  type << node.type();
  refuse(name_ + " is of type " + type.str(), file_, node.source(), "give " + wanted);
}

double Entry::number(const toml::node& node, double min, double max) const {
  if (!node.is_number()) wrong_type(node, "a number from " + range(min, max));
  // A TOML number always has a value as double: integers of 64 bits round.
  const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get())
                                         : node.as_floating_point()->get();
  if (!(value >= min && value <= max)) {
    refuse(name_ + " = " + to_text(value) + " is out of range", file_, node.source(),
           "give a number from " + range(min, max));
  }
  return value;
}

std::uint32_t Entry::count(std::uint32_t min, std::uint32_t max) const {
  const std::string wanted =
      "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  if (!node_.is_integer()) wrong_type(node_, wanted);
  const std::int64_t value = node_.as_integer()->get();
  if (value < std::int64_t(min) || value > std::int64_t(max)) {
    refuse(name_ + " = " + std::to_string(value) + " is out of range", file_, node_.source(),
           "give " + wanted);
  }
  return static_cast<std::uint32_t>(value);
}

bool Entry::flag() const {
  if (!node_.is_boolean()) wrong_type(node_, "true or false");
  return node_.as_boolean()->get();
}

std::size_t Entry::choice(std::span<const std::string_view> words) const {
  const std::vector<std::string_view> names(words.begin(), words.end());
  if (!node_.is_string())
    wrong_type(node_, known_names("", names).substr(std::string("use ").size()));
  const std::string& value = node_.as_string()->get();
  const auto found = std::find(words.begin(), words.end(), value);
  if (found == words.end()) {
    refuse(name_ + " = '" + value + "' is unknown", file_, node_.source(),
           known_names(value, names));
  }
  return static_cast<std::size_t>(found - words.begin());
}

std::string Entry::text() const {
  if (!node_.is_string()) wrong_type(node_, "a text in quotes");
  std::string value = node_.as_string()->get();
  const auto is_control = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; };
  if (value.empty() || std::any_of(value.begin(), value.end(), is_control)) {
    refuse(name_ + " is empty or holds control characters", file_, node_.source(),
           "give a text of one line");
  }
  return value;
}

void Entry::numbers(std::span<double> out, double limit) const {
  const std::string wanted = std::to_string(out.size()) + " numbers in brackets";
  const toml::array* array = node_.as_array();
  if (!array) wrong_type(node_, wanted);
  if (array->size() != out.size()) {
    refuse(name_ + " has " + std::to_string(array->size()) + " elements", file_, node_.source(),
           "give " + wanted);
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = number(*array->get(i), -limit, limit);
}

Quat Entry::orientation() const {
  double x[4];
  numbers(x, 1 + kUnitTolerance);
  Quat q = {x[0], x[1], x[2], x[3]};
  if (!make_unit(q)) {
    refuse(name_ + " is not a unit quaternion", file_, node_.source(),
           "give w, x, y, z of length 1 within " + to_text(kUnitTolerance) +
               "; [1, 0, 0, 0] is no rotation");
  }
  return q;
}

}  // namespace palpate::config
