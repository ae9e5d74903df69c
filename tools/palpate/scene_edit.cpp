// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/scene_edit.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <vector>

#include "config/scene_keys.hpp"

namespace palpate::cli {
namespace {

struct Edit {
  std::size_t from = 0, to = 0;  ///< bytes of the text
  std::string with;
};

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// A real number is written as one, not as an integer.
std::string value_text(const toml::node& value) {
  if (const auto* real = value.as_floating_point()) {
    const std::string text = config::to_text(real->get());
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  const auto* text = value.as_string();
  const bool plain = text && text->get().find_first_of("\"\\") == std::string::npos;
  if (plain && std::none_of(text->get().begin(), text->get().end(), is_control)) {
    return '"' + text->get() + '"';
  }
  std::ostringstream out;
  out << toml::node_view<const toml::node>(&value);
  return out.str();
}

class SceneText {
 public:
  explicit SceneText(const std::string& text) : text_(text), was_(toml::parse(text)) {
    lines_ = {0, 0};  // counted from 1
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') lines_.push_back(i + 1);
    }
    lines_.push_back(text.size());
  }

  void replace_engine(const toml::table& wanted) {
    const toml::table* engine = was_["engine"].as_table();
    std::string added;
    for (const auto& [key, value] : wanted) {
      const toml::node* old = engine ? engine->get(key) : nullptr;
      if (!old) {
        added += std::string(key.str()) + " = " + value_text(value) + "\n";
      } else if (value_text(*old) != value_text(value)) {
        replace(*old, value_text(value));
      }
    }
    if (engine) {
      for (const auto& [key, value] : *engine) {
        if (!wanted.contains(key)) remove_line(key.source().begin.line);
      }
      if (!added.empty()) insert(line(engine->source().begin.line + 1), added);
    } else {
      insert(text_.size(), "\n[engine]\n" + added);
    }
  }

  void replace_images(const toml::array& wanted) {
    const toml::array& bodies = *was_["body"].as_array();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const toml::node& old = *bodies[i].as_table()->get("image");
      replace(old, value_text(*wanted[i].as_table()->get("image")));
    }
  }

  [[nodiscard]] std::string text() {
    std::string out = text_;
    std::stable_sort(edits_.begin(), edits_.end(),
                     [](const Edit& a, const Edit& b) { return a.from > b.from; });
    for (const Edit& edit : edits_) out.replace(edit.from, edit.to - edit.from, edit.with);
    return out;
  }

 private:
  [[nodiscard]] std::size_t line(std::size_t number) const {
    return lines_[std::min(number, lines_.size() - 1)];
  }
  [[nodiscard]] std::size_t at(toml::source_position p) const {
    return std::min(line(p.line) + p.column - 1, text_.size());
  }

  void replace(const toml::node& old, const std::string& with) {
    edits_.push_back({at(old.source().begin), at(old.source().end), with});
  }
  void remove_line(std::size_t number) { edits_.push_back({line(number), line(number + 1), ""}); }
  void insert(std::size_t where, const std::string& with) {
    edits_.push_back({where, where, with});
  }

  const std::string& text_;
  toml::table was_;
  std::vector<std::size_t> lines_;
  std::vector<Edit> edits_;
};

bool holds(const std::string& text, const toml::table& wanted) {
  try {
    return toml::parse(text) == wanted;
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

std::string edited_scene(const std::string& text, const toml::table& wanted) {
  SceneText scene(text);
  scene.replace_engine(*wanted["engine"].as_table());
  scene.replace_images(*wanted["body"].as_array());
  std::string edited = scene.text();
  if (holds(edited, wanted)) return edited;
  std::ostringstream anew;
  anew << wanted << "\n";
  return anew.str();
}

}  // namespace palpate::cli
