// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers of a text file, with the line for errors. Lines end in LF, CR LF, CR CR LF (a
// CR LF that was converted again) or CR alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::bake {

class Text {
 public:
  struct Rules {
    bool comments = false;       ///< a word that begins with '#' ends the line
    bool continuations = false;  ///< a backslash at the end of a line joins the next one
  };
  Text(std::string_view bytes, std::string file, Rules rules)
      : bytes_(bytes), file_(std::move(file)), rules_(rules) {}

  /// The next word, on this line or a later one; empty at the end of the file.
  std::string_view word();
  /// The next word on this line; empty where there is none.
  std::string_view word_on_line();
  /// Skips what is left of the line; returns its end, empty at the end of the file.
  std::string_view skip_line();
  /// The same where a line can only end as the given one: bytes behind it belong to binary data.
  void skip_line_ending_as(std::string_view line_end);
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  /// Bytes not yet read.
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  /// The unread bytes.
  [[nodiscard]] std::string_view rest() const { return bytes_.substr(at_); }

  /// The whole word as a number; throws InputRefused otherwise. `what` names it: "coordinate".
  [[nodiscard]] double number(std::string_view word, std::string_view what) const;
  [[nodiscard]] std::int64_t integer(std::string_view word, std::string_view what) const;

  /// Throws InputRefused at `file:line`.
  [[noreturn]] void refuse(const std::string& what, const std::string& fix) const;

 private:
  void skip_blanks();
  [[nodiscard]] std::string_view line_end_at(std::size_t at) const;

  std::string_view bytes_;
  std::string file_;
  Rules rules_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

/// What a message shows of a word of the file: short, printable, in quotes.
std::string quoted(std::string_view word);

/// Equal apart from the case of ASCII letters? `lower` is in lower case.
bool equals_caseless(std::string_view word, std::string_view lower);

}  // namespace palpate::bake
