// SPDX-License-Identifier: GPL-3.0-or-later
// The executable's frame: the table of sub-commands, and every error turned into one line and an
// exit status.
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <initializer_list>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "rt_core/image/format.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/error_line.hpp"

namespace palpate::cli {
namespace {

// In the order in which --help lists them.
constexpr std::initializer_list<void (*)(CLI::App&)> kCommands = {
    // clang-format off
    add_make_model,
    add_make_motion,
    add_check,
    add_bake,
    add_new_scene,
    add_try,
    add_inspect,
    add_emit,
    add_replay,
    add_sweep,
    add_run,
    add_report,
    add_devices,
    add_flash,
    add_key,
    add_doctor,
    // clang-format on
};

constexpr const char* kFooter =
    "Exit status: 0 done; 2 the command line or a config file is wrong; 3 an input (mesh, image, "
    "pose file) is refused;\n"
    "4 a device is missing or failed; 5 a promise was broken during a run; 1 anything else.\n"
    "Units are SI: metres, newtons, newton-metres, seconds, radians.";

std::string version() {
  return "palpate " PALPATE_VERSION ", image format " + std::to_string(image::kFormatMajor) + "." +
         std::to_string(image::kFormatMinor) +
         ", " PALPATE_BUILD ", float32 geometry, double solves";
}

int error(const std::string& message, Exit code) {
  print_error("palpate", message);
  return code;
}

/// One line for a mistake of the command line. CLI11 looks for a sub-command before it looks at
/// what it got instead.
std::string usage_error(const CLI::App& app, const CLI::ParseError& e) {
  const auto chosen = app.get_subcommands();
  const std::string name = chosen.empty() ? "palpate" : "palpate " + chosen.front()->get_name();
  const std::vector<std::string> unknown = app.remaining();
  const bool no_command = chosen.empty() && !unknown.empty();
  const std::string what =
      no_command ? "unknown command or option '" + unknown.front() + "'" : e.what();
  return what + ": " + name + ": see '" + name + " --help'";
}

/// The reader of a pipe may leave when it has seen enough: no error. A full disk is one.
int finish_output(int code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good()) return code;
  pollfd out = {STDOUT_FILENO, 0, 0};
  const bool reader_left = ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
  if (reader_left || code != kDone) return code;
  return error("cannot write: standard output: give it a place that is writable and has room",
               kOther);
}

int run(int argc, char** argv) {
  CLI::App app("Haptic contact between detailed rigid objects inside a hard time budget");
  app.name("palpate");
  app.footer(kFooter);
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  for (const auto add : kCommands) add(app);
  for (CLI::App* command : app.get_subcommands({})) {  // one that wrote its own keeps it above ours
    const std::string footer = command->get_footer();
    if (footer != kFooter) command->footer(footer + "\n\n" + kFooter);
  }
  try {
    app.parse(argc, argv);
    return exit_status();
  } catch (const CLI::Success& e) {
    return app.exit(e);  // --help and --version
  } catch (const CLI::ParseError& e) {
    return error(usage_error(app, e), kUsage);
  }
}

int run_and_report(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Failure& e) {
    return error(e.what(), e.code);
  } catch (const config::ConfigError& e) {
    return error(e.what(), kUsage);
  } catch (const bake::InputRefused& e) {
    return error(e.what(), kRefused);
  } catch (const std::bad_alloc&) {
    return error("out of memory: this process: use a smaller input or a machine with more memory",
                 kOther);
  } catch (...) {
    return error(internal_error(), kOther);
  }
}

}  // namespace
}  // namespace palpate::cli

int main(int argc, char** argv) {
  // A closed pipe must end neither the real-time loop nor the writing of files.
  std::signal(SIGPIPE, SIG_IGN);
  return palpate::cli::finish_output(palpate::cli::run_and_report(argc, argv));
}
