// SPDX-License-Identifier: Apache-2.0
// The one table of everything that may stand in a scene file: the loader reads by it, README.md
// shows it, errors quote it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "config/scene.hpp"

namespace palpate::config {

// What a key's value is, and where it goes in the struct T.

template <class T>
struct Real {
  double& (*at)(T&);
  double min, max;  ///< both allowed
};

template <class T>
struct OptionalReal {  ///< has no default: its absence means something
  std::optional<double>& (*at)(T&);
  double min, max;
};

template <class T>
struct Count {
  std::uint32_t& (*at)(T&);
  std::uint32_t min, max;
};

template <class T>
struct Flag {
  bool& (*at)(T&);
};

template <class T>
struct Choice {
  std::span<const std::string_view> words;
  void (*set)(T&, std::size_t index);
  std::size_t (*get)(const T&);
};

template <class T>
struct Text {  ///< not empty, without control characters
  void (*set)(T&, const std::string&);
};

template <class T>
struct Position {  ///< three numbers
  Vec3d& (*at)(T&);
};

template <class T>
struct Orientation {  ///< four numbers, w x y z; see unit_quaternion.hpp
  Quat& (*at)(T&);
};

/// One key of a table that fills a T.
template <class T>
struct Key {
  std::string_view name;
  std::string_view unit;  ///< empty where there is none
  std::variant<Real<T>, OptionalReal<T>, Count<T>, Flag<T>, Choice<T>, Text<T>, Position<T>,
               Orientation<T>>
      value;
  std::string_view meaning;
  bool required = false;
};

/// One table of the file.
template <class T>
struct Table {
  std::string_view name;
  std::span<const Key<T>> keys;
  std::string_view meaning;
};

/// A [[pair]] as written.
struct PairNames {
  std::string a, b;
  double friction = 0;
};

inline constexpr double kMaxPosition_m = 1e12;  ///< of each coordinate, either sign

std::span<const Table<Scene>> tables();   ///< [engine], [force], [limits], [run], [mock]
const Table<Waypoint>& waypoint_table();  ///< [[mock.path]]
const Table<Body>& body_table();          ///< [[body]]
const Table<PairNames>& pair_table();     ///< [[pair]]

/// The shortest text that reads back as the same number.
std::string to_text(double value);

/// All tables in Markdown; README.md holds exactly this.
std::string key_tables();

}  // namespace palpate::config
