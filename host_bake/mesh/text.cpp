// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/text.hpp"

#include <algorithm>
#include <charconv>

#include "host_bake/base/error.hpp"

namespace palpate::bake {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

constexpr std::string_view kLineEnds[] = {"\n", "\r\n", "\r\r\n", "\r"};

bool ends_line(char c) { return c == '\n' || c == '\r'; }

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
    const std::string_view line_end = line_end_at(at_ + 1);
    if (line_end.empty()) return;
    at_ += line_end.size();
    ++line_;
  }
}

std::string_view Text::word_on_line() {
  skip_blanks();
  const std::size_t begin = at_;
  while (at_ < bytes_.size() && !ends_line(bytes_[at_]) && !is_blank(bytes_[at_])) ++at_;
  const std::string_view word = bytes_.substr(begin, at_ - begin);
  if (rules_.comments && word.starts_with('#')) {
    at_ = std::min(bytes_.find_first_of("\r\n", begin), bytes_.size());
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

std::string_view Text::line_end_at(std::size_t at) const {
  for (const std::string_view line_end : kLineEnds) {
    if (at < bytes_.size() && bytes_.substr(at).starts_with(line_end)) return line_end;
  }
  return {};
}

std::string_view Text::skip_line() {
  at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
  const std::string_view line_end = line_end_at(at_);
  at_ += line_end.size();
  if (!line_end.empty()) ++line_;
  return line_end;
}

void Text::skip_line_ending_as(std::string_view line_end) {
  const std::size_t begin = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
  if (line_end.empty() || !bytes_.substr(begin).starts_with(line_end)) {
    skip_line();
    return;
  }
  at_ = begin + line_end.size();
  ++line_;
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

void Text::refuse(const std::string& what, const std::string& fix) const {
  throw InputRefused(what, file_ + ":" + std::to_string(line_), fix);
}

std::string quoted(std::string_view word) {
  constexpr std::size_t kMostShown = 24;
  std::string text = "'";
  for (const char c : word.substr(0, kMostShown)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > kMostShown ? "...'" : "'");
}

bool equals_caseless(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

}  // namespace palpate::bake
