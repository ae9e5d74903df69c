// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/text.hpp"

#include <algorithm>
#include <charconv>

#include "host_bake/base/error.hpp"

namespace palpate::bake {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// What a message shows of a word of the file: short, printable.
std::string quoted(std::string_view word) {
  constexpr std::size_t kMostShown = 24;
  std::string text = "'";
  for (const char c : word.substr(0, kMostShown)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > kMostShown ? "...'" : "'");
}

/// from_chars knows no plus sign.
std::string_view without_plus(std::string_view word) {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
  return plus ? word.substr(1) : word;
}

template <typename T>
bool parse(std::string_view word, T& out) {
  const std::string_view w = without_plus(word);
  const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), out);
  return error == std::errc{} && end == w.data() + w.size();
}

}  // namespace

void Text::skip_blanks() {
  for (; at_ < bytes_.size(); ++at_) {
    if (is_blank(bytes_[at_])) continue;
    if (!rules_.continuations || bytes_[at_] != '\\') return;
    const std::size_t next = bytes_.find_first_not_of('\r', at_ + 1);
    if (next == std::string_view::npos || bytes_[next] != '\n') return;
    at_ = next;
    ++line_;
  }
}

std::string_view Text::word_on_line() {
  skip_blanks();
  const std::size_t begin = at_;
  while (at_ < bytes_.size() && bytes_[at_] != '\n' && !is_blank(bytes_[at_])) ++at_;
  const std::string_view word = bytes_.substr(begin, at_ - begin);
  if (rules_.comments && word.starts_with('#')) {
    at_ = std::min(bytes_.find('\n', begin), bytes_.size());
    return {};
  }
  return word;
}

std::string_view Text::word() {
  for (;;) {
    const std::string_view found = word_on_line();
    if (!found.empty() || at_end()) return found;
    skip_line();
  }
}

void Text::skip_line() {
  const std::size_t newline = bytes_.find('\n', at_);
  at_ = newline == std::string_view::npos ? bytes_.size() : newline + 1;
  if (newline != std::string_view::npos) ++line_;
}

double Text::number(std::string_view word, std::string_view what) const {
  double value = 0;
  if (!parse(word, value)) {
    refuse(
        std::string(what) + (word.empty() ? " missing" : " " + quoted(word) + " is not a number"),
        "export the mesh again");
  }
  return value;
}

std::int64_t Text::integer(std::string_view word, std::string_view what) const {
  std::int64_t value = 0;
  if (!parse(word, value)) {
    refuse(std::string(what) +
               (word.empty() ? " missing" : " " + quoted(word) + " is not a whole number"),
           "export the mesh again");
  }
  return value;
}

void Text::refuse(const std::string& what, const std::string& mend) const {
  throw InputRefused(what, file_ + ":" + std::to_string(line_), mend);
}

bool equals_caseless(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

}  // namespace palpate::bake
