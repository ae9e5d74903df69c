// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/command.hpp"

#include "tools/palpate/output_file.hpp"

namespace palpate::cli {
namespace {

Exit& status() {
  static Exit value = kDone;
  return value;
}

}  // namespace

void set_exit(Exit code) { status() = code; }
Exit exit_status() { return status(); }

void write_file(const std::filesystem::path& target, std::span<const std::byte> bytes) {
  OutputFile(target, bytes).commit();
}

void write_file(const std::filesystem::path& target, std::string_view text) {
  write_file(target, std::as_bytes(std::span(text)));
}

}  // namespace palpate::cli
