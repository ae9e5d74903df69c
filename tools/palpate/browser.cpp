// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/browser.hpp"

#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

extern char** environ;

namespace palpate::cli {

bool has_screen() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

bool open_on_screen(const std::string& what) {
  if (!has_screen()) return false;
  std::string opener = "xdg-open", argument = what;
  char* const arguments[] = {opener.data(), argument.data(), nullptr};
  pid_t process = 0;
  return ::posix_spawnp(&process, opener.c_str(), nullptr, nullptr, arguments, environ) == 0;
}

Signpost::Signpost(const std::string& address) {
  constexpr std::string_view kEnding = ".html";
  file_ = (std::filesystem::temp_directory_path() / "palpate-XXXXXX").string();
  file_ += kEnding;
  const int file = ::mkstemps(file_.data(), static_cast<int>(kEnding.size()));  // mode 0600
  if (file < 0) throw std::system_error(errno, std::generic_category(), file_);
  const std::string text =
      "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" "
      "content=\"no-referrer\"><meta http-equiv=\"refresh\" content=\"0;url=" +
      address + "\"><title>Palpate</title>\n";
  const bool whole = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  ::close(file);
  if (whole) return;
  ::unlink(file_.c_str());
  throw std::system_error(error, std::generic_category(), file_);
}

Signpost::~Signpost() { ::unlink(file_.c_str()); }

}  // namespace palpate::cli
