// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/error_line.hpp"

#include <cstdio>
#include <exception>

namespace palpate::cli {

void print_error(const char* program, std::string message) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "%s: error: %s\n", program, message.c_str());
}

std::string internal_error() {
  const std::string fix = ": internal: please report it with the command line";
  try {
    throw;
  } catch (const std::exception& e) {
    return e.what() + fix;
  } catch (...) {
    return "unknown failure" + fix;
  }
}

}  // namespace palpate::cli
