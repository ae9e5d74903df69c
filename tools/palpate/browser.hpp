// SPDX-License-Identifier: GPL-3.0-or-later
// Shows a page to whoever sits at the screen.
#pragma once

#include <filesystem>
#include <string>

namespace palpate::cli {

/// Whether there is a screen to open anything on.
[[nodiscard]] bool has_screen();

/// Opens a file or an address with the desktop's own program. False where there is no screen or no
/// such program. Does not wait for it.
bool open_on_screen(const std::string& what);

/// A file that leads a browser to an address. Command lines can be read by everybody on a machine,
/// this file by its owner alone; it goes with this object.
class Signpost {
 public:
  /// Throws std::system_error.
  explicit Signpost(const std::string& address);
  ~Signpost();
  Signpost(const Signpost&) = delete;
  Signpost& operator=(const Signpost&) = delete;
  Signpost(Signpost&&) = delete;
  Signpost& operator=(Signpost&&) = delete;

  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

}  // namespace palpate::cli
