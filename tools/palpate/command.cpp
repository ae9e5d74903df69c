// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/command.hpp"

#include "config/scene_keys.hpp"
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

CLI::Validator number_between(double min, double max) {
  const std::string range = config::to_text(min) + " to " + config::to_text(max);
  const auto check = [min, max, range](const std::string& text) {
    double value = 0;
    const bool ok = CLI::detail::lexical_cast(text, value) && value >= min && value <= max;
    return ok ? std::string() : "'" + text + "' is no number from " + range;
  };
  return {check, range, "number"};
}

}  // namespace palpate::cli
