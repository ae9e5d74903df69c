// SPDX-License-Identifier: GPL-3.0-or-later
// palpate doctor: is this host ready for the real-time loop?
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/palpate/command.hpp"
#include "tools/realtime/host_checks.hpp"

namespace palpate::cli {
namespace {

void print(const realtime::HostCheck& check) {
  std::cout << (check.ok ? "ok    " : "fix   ") << check.check << ": " << check.found << "\n";
  if (check.ok) return;
  std::cout << "        wanted: " << check.wanted << "\n        fix:    " << check.fix << "\n";
}

nlohmann::json to_json(const realtime::HostCheck& check) {
  return {{"check", check.check},
          {"ok", check.ok},
          {"found", check.found},
          {"wanted", check.wanted},
          {"mend", check.fix}};
}

void doctor(bool json) {
  const auto checks = realtime::check_host(realtime::host_rights(), "/", realtime::set_up_script());
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& check : checks) list.push_back(to_json(check));
    std::cout << list.dump(2) << "\n";
  } else {
    for (const auto& check : checks) print(check);
  }
  const bool ready = std::all_of(checks.begin(), checks.end(), [](const auto& c) { return c.ok; });
  if (!ready) set_exit(kOther);
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("doctor",
                         "Say whether this host is ready for the real-time loop; exit status 1 "
                         "where something is to be fixed");
  command->add_flag("--json", *json, "print a JSON list");
  command->callback([json] { doctor(*json); });
}

}  // namespace palpate::cli
