// SPDX-License-Identifier: Apache-2.0
// Reads one TOML table into a struct, by the keys of scene_keys.hpp.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene_keys.hpp"
#include "config/unit_quaternion.hpp"

namespace palpate::config {

/// Throws ConfigError `what: file:line: fix`.
[[noreturn]] void refuse(const std::string& what, const std::string& file,
                         const toml::source_region& at, const std::string& fix);

/// `did you mean 'delta_m'? use one of delta_m, s0`; the question only where a known name is near.
std::string known_names(std::string_view wrong, const std::vector<std::string_view>& names);

/// One key of the file on its way into a struct: says what is wrong with it, and where.
class Entry {
 public:
  Entry(const std::string& file, std::string_view table, std::string_view key,
        const toml::node& node)
      : file_(file), name_(std::string(table) + " " + std::string(key)), node_(node) {}

  template <class T>
  void read(const Real<T>& v, T& out) const {
    v.at(out) = number(node_, v.min, v.max);
  }
  template <class T>
  void read(const OptionalReal<T>& v, T& out) const {
    v.at(out) = number(node_, v.min, v.max);
  }
  template <class T>
  void read(const Count<T>& v, T& out) const {
    v.at(out) = count(v.min, v.max);
  }
  template <class T>
  void read(const Flag<T>& v, T& out) const {
    v.at(out) = flag();
  }
  template <class T>
  void read(const Choice<T>& v, T& out) const {
    v.set(out, choice(v.words));
  }
  template <class T>
  void read(const Text<T>& v, T& out) const {
    v.set(out, text());
  }
  template <class T>
  void read(const Position<T>& v, T& out) const {
    double x[3];
    numbers(x, kMaxPosition_m);
    v.at(out) = {x[0], x[1], x[2]};
  }
  template <class T>
  void read(const Orientation<T>& v, T& out) const {
    v.at(out) = orientation();
  }

 private:
  [[noreturn]] void wrong_type(const toml::node& node, const std::string& wanted) const;
  [[nodiscard]] double number(const toml::node& node, double min, double max) const;
  [[nodiscard]] std::uint32_t count(std::uint32_t min, std::uint32_t max) const;
  [[nodiscard]] bool flag() const;
  [[nodiscard]] std::size_t choice(std::span<const std::string_view> words) const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Quat orientation() const;
  void numbers(std::span<double> out, double limit) const;

  const std::string& file_;
  std::string name_;
  const toml::node& node_;
};

/// Fills `out` from the table. Names in `nested` are left to the caller; every other unknown one is
/// refused, and so is the absence of a required key.
template <class T>
void read_table(const std::string& file, const Table<T>& table, const toml::table& source, T& out,
                const std::vector<std::string_view>& nested = {}) {
  std::vector<std::string_view> names = nested;
  for (const Key<T>& key : table.keys) names.push_back(key.name);
  for (const auto& [key, node] : source) {
    if (std::find(names.begin(), names.end(), key.str()) == names.end()) {
      refuse("unknown key '" + std::string(key.str()) + "' in " + std::string(table.name), file,
             key.source(), known_names(key.str(), names));
    }
  }
  for (const Key<T>& key : table.keys) {
    if (const toml::node* node = source.get(key.name)) {
      const Entry entry(file, table.name, key.name, *node);
      std::visit([&](const auto& v) { entry.read(v, out); }, key.value);
    } else if (key.required) {
      refuse("missing key '" + std::string(key.name) + "' in " + std::string(table.name), file,
             source.source(), "add " + std::string(key.name) + ": " + std::string(key.meaning));
    }
  }
}

}  // namespace palpate::config
