// SPDX-License-Identifier: GPL-3.0-or-later
// What the sub-commands of `palpate` share. Each sub-command is one file with one add_...()
// function, listed in main.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host_bake/base/error.hpp"

namespace palpate::cli {

/// Exit statuses of docs and scripts; see `palpate --help`.
enum Exit : int {
  kDone = 0,
  kOther = 1,
  kUsage = 2,
  kRefused = 3,
  kDevice = 4,
  kPromiseBroken = 5
};

/// Ends the command: one line `palpate: error: WHAT: WHERE: HOW TO FIX` on stderr, then this
/// status.
struct Failure : std::runtime_error {
  Failure(Exit code_, const std::string& what, const std::string& where, const std::string& fix)
      : std::runtime_error(what + ": " + where + ": " + fix), code(code_) {}
  Exit code;
};

/// Set by a command that finished but has to report a status other than 0 (a broken promise);
/// printed results stay.
void set_exit(Exit code);
[[nodiscard]] Exit exit_status();

/// Writes the whole file or none (see output_file.hpp). Throws Failure(kOther).
void write_file(const std::filesystem::path& target, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& target, std::string_view text);

/// Shows work that takes longer than a second on stderr: a bar on a terminal (stage, percent, time
/// the stage still takes), plain lines when piped, nothing with quiet. The bar is wiped when the
/// last copy of the result is destroyed.
bake::Progress progress(bool quiet);

/// The most that options take for a number of threads.
constexpr unsigned kMaxThreads = 1024;

/// For options: a finite number, both ends allowed. CLI::Range lets NaN pass, and unsigned options
/// wrap -1 around.
CLI::Validator number_between(double min, double max);

void add_make_model(CLI::App& app);
void add_make_motion(CLI::App& app);
void add_check(CLI::App& app);
void add_bake(CLI::App& app);
void add_new_scene(CLI::App& app);
void add_try(CLI::App& app);
void add_inspect(CLI::App& app);
void add_emit(CLI::App& app);
void add_replay(CLI::App& app);
void add_sweep(CLI::App& app);
void add_run(CLI::App& app);
void add_report(CLI::App& app);
void add_devices(CLI::App& app);
void add_flash(CLI::App& app);
void add_key(CLI::App& app);
void add_doctor(CLI::App& app);

}  // namespace palpate::cli
