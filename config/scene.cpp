// SPDX-License-Identifier: Apache-2.0
#include "config/scene.hpp"

#include "config/read_table.hpp"
#include "config/text_file.hpp"

namespace palpate::config {
namespace {

/// A description of one line and no more.
std::string one_line(std::string_view text) { return std::string(text.substr(0, text.find('\n'))); }

/// Walks one scene file; the members are the steps, in their order.
class Loader {
 public:
  Loader(const std::filesystem::path& file, const toml::table& root)
      : file_(file.string()), root_(root) {
    scene_.file = file;
  }

  Scene load() {
    refuse_unknown_tables();
    for (const Table<Scene>& table : tables()) read_section(table);
    read_path();
    read_bodies();
    read_pairs();
    return std::move(scene_);
  }

 private:
  void refuse_unknown_tables() const {
    std::vector<std::string_view> names;
    for (const Table<Scene>& table : tables()) names.push_back(bare(table.name));
    names.push_back(bare(body_table().name));
    names.push_back(bare(pair_table().name));
    for (const auto& [key, node] : root_) {
      if (std::find(names.begin(), names.end(), key.str()) == names.end()) {
        const std::string what = node.is_table() ? "unknown table '" : "unknown key '";
        refuse(what + std::string(key.str()) + "'", file_, key.source(),
               known_names(key.str(), names));
      }
    }
  }

  void read_section(const Table<Scene>& table) {
    const toml::node* node = root_.get(bare(table.name));
    if (!node) return;
    const toml::table* section = node->as_table();
    if (!section)
      refuse("'" + std::string(bare(table.name)) + "' is no table", file_, node->source(),
             "write " + std::string(table.name) + " and its keys below");
    if (table.name == "[mock]") {
      read_table(file_, table, *section, scene_, {kPath});
    } else {
      read_table(file_, table, *section, scene_);
    }
  }

  void read_path() {
    const toml::table* mock = root_.get_as<toml::table>("mock");
    if (!mock) return;
    for (const toml::table* row : rows(*mock, kPath, waypoint_table().name)) {
      Waypoint point;
      read_table(file_, waypoint_table(), *row, point);
      const bool first = scene_.hand.path.empty();
      if (first ? point.t_s != 0 : point.t_s <= scene_.hand.path.back().t_s) {
        refuse("[[mock.path]] t_s = " + to_text(point.t_s) + " is out of order", file_,
               row->get("t_s")->source(),
               first ? "start the path at 0"
                     : "give a time after " + to_text(scene_.hand.path.back().t_s));
      }
      scene_.hand.path.push_back(point);
    }
  }

  void read_bodies() {
    bool have_tool = false;
    for (const toml::table* row : rows(root_, bare(body_table().name), body_table().name)) {
      Body body;
      read_table(file_, body_table(), *row, body);
      check_name(body.name, *row);
      if (scene_.bodies.size() == kMaxBodies) {
        refuse("too many bodies", file_, row->source(),
               "leave it at " + std::to_string(kMaxBodies));
      }
      if (body.role == Role::tool) {
        if (have_tool)
          refuse("a second tool", file_, row->source(),
                 "give one body the role \"tool\", the others another");
        have_tool = true;
        scene_.tool = static_cast<std::uint32_t>(scene_.bodies.size());
      }
      body.image = std::filesystem::absolute(scene_.file).parent_path() / body.image;
      scene_.bodies.push_back(std::move(body));
    }
    if (!have_tool || scene_.bodies.size() < 2) {
      refuse(have_tool ? "only one body" : "no body is the tool", file_, root_.source(),
             "write two or more [[body]], one of them with role = \"tool\"");
    }
  }

  void check_name(const std::string& name, const toml::table& row) const {
    if (name.find_first_of(",\"' \t") != std::string::npos) {
      refuse("[[body]] name '" + name + "' holds a comma, a quote or a space", file_,
             row.get("name")->source(),
             "pose files could not name it: use letters, digits, _ and -");
    }
    for (const Body& other : scene_.bodies) {
      if (other.name == name) {
        refuse("a second body named '" + name + "'", file_, row.get("name")->source(),
               "give every body its own name");
      }
    }
  }

  void read_pairs() {
    for (const toml::table* row : rows(root_, bare(pair_table().name), pair_table().name)) {
      PairNames names;
      read_table(file_, pair_table(), *row, names);
      const BodyPair pair = {find_body(names.a, *row->get("a")),
                             find_body(names.b, *row->get("b"))};
      if (pair.a == pair.b)
        refuse("[[pair]] of a body with itself", file_, row->source(), "name two bodies");
      for (const BodyPair& other : scene_.pairs) {
        if ((other.a == pair.a && other.b == pair.b) || (other.a == pair.b && other.b == pair.a)) {
          refuse("[[pair]] of '" + names.a + "' and '" + names.b + "' a second time", file_,
                 row->source(), "remove it");
        }
      }
      if (scene_.pairs.size() == kMaxPairs) {
        refuse("too many pairs", file_, row->source(), "leave it at " + std::to_string(kMaxPairs));
      }
      scene_.pairs.push_back(pair);
      scene_.friction.push_back(names.friction);
    }
    if (!scene_.pairs.empty()) return;
    for (std::uint32_t i = 0; i < scene_.bodies.size(); ++i) {
      if (i != scene_.tool) scene_.pairs.push_back({scene_.tool, i});
    }
    scene_.friction.assign(scene_.pairs.size(), 0);
  }

  [[nodiscard]] std::uint32_t find_body(const std::string& name, const toml::node& at) const {
    std::vector<std::string_view> names;
    for (const Body& body : scene_.bodies) names.push_back(body.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      refuse("no body is named '" + name + "'", file_, at.source(), known_names(name, names));
    return static_cast<std::uint32_t>(found - names.begin());
  }

  /// The rows of an array of tables; none where it is absent.
  [[nodiscard]] std::vector<const toml::table*> rows(const toml::table& parent,
                                                     std::string_view key,
                                                     std::string_view name) const {
    const toml::node* node = parent.get(key);
    if (!node) return {};
    std::vector<const toml::table*> out;
    if (const toml::array* array = node->as_array()) {
      for (const toml::node& row : *array) out.push_back(row.as_table());
    }
    if (out.empty() || std::find(out.begin(), out.end(), nullptr) != out.end()) {
      refuse("'" + std::string(key) + "' is no array of tables", file_, node->source(),
             "write " + std::string(name) + " above the keys of each");
    }
    return out;
  }

  /// `engine` of `[engine]`.
  static std::string_view bare(std::string_view name) {
    const std::size_t first = name.find_first_not_of('['), end = name.find(']');
    return name.substr(first, end - first);
  }

  static constexpr std::string_view kPath = "path";

  std::string file_;
  const toml::table& root_;
  Scene scene_;
};

}  // namespace

Scene load_scene(const std::filesystem::path& file) {
  std::string text;
  if (const std::error_code error = read_text(file, text)) {
    throw ConfigError("cannot read the scene (" + error.message() + "): " + file.string() +
                      ": give a scene file that exists and is readable");
  }
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& e) {
    refuse("not TOML (" + one_line(e.description()) + ")", file.string(), e.source(),
           "fix the line");
  }
  return Loader(file, root).load();
}

}  // namespace palpate::config
