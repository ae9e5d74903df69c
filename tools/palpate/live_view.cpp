// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/live_view.hpp"

#include <chrono>
#include <iostream>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/palpate/command.hpp"
#include "tools/palpate/report_json.hpp"
#include "tools/palpate/report_page.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::cli {
namespace {

constexpr std::chrono::seconds kWaitForPage(10);

/// What the numbers of frames stand for.
nlohmann::ordered_json names_json() {
  nlohmann::ordered_json states, faults;
  for (int i = 0; i <= static_cast<int>(realtime::LoopState::homing); ++i) {
    states.push_back(realtime::name(static_cast<realtime::LoopState>(i)));
  }
  for (int i = 0; i < realtime::kFaultCount; ++i) {
    faults.push_back(realtime::name(static_cast<realtime::Fault>(i)));
  }
  return {{"states", states}, {"faults", faults}};
}

nlohmann::ordered_json live_json(const config::Scene& scene, const LiveViewOptions& options) {
  nlohmann::ordered_json json = {{"version", PALPATE_VERSION},
                                 {"name", scene.file.filename().string()},
                                 {"device", options.device},
                                 {"lead", bool(options.lead)},
                                 {"rate_Hz", options.rate_Hz},
                                 {"budget_us", nullptr},
                                 {"max_force_N", scene.settings.max_force_N},
                                 {"strip_s", live::kStrip_s},
                                 {"head_numbers", live::kHeadNumbers},
                                 {"names", names_json()},
                                 {"view", scene_json(scene)}};
  if (scene.budget_us) json["budget_us"] = *scene.budget_us;
  return json;
}

}  // namespace

LiveView::LiveView(const config::Scene& scene, LiveViewOptions options)
    : tap_(std::make_unique<realtime::LiveTap>()),
      origin_m_(scene.bodies[scene.tool].pose.position_m),
      browser_(options.browser) {
  const std::string page = fill_page(live_page(), live_json(scene, options));
  feed_ = std::make_unique<live::Feed>(*tap_, options.rate_Hz, scene.bodies[scene.tool].pose,
                                       std::move(options.lead));
  try {
    server_ = std::make_unique<live::Server>(page, options.port, *feed_);
  } catch (const std::system_error& e) {
    throw Failure(kOther, std::string("cannot serve the live view (") + e.code().message() + ")",
                  "port " + std::to_string(options.port),
                  "give another as --view=PORT, or none for any that is free");
  }
}

LiveView::~LiveView() = default;

void LiveView::end() {
  feed_->end();
  server_.reset();
}

void LiveView::announce() {
  std::cerr << "Live view: " << server_->address() << "\n" << std::flush;
  if (!browser_ || !has_screen()) return;
  try {
    signpost_.emplace(server_->address());
  } catch (const std::system_error&) {
    return;  // nowhere to put it: the address has been said
  }
  if (!open_on_screen(signpost_->file())) return;
  const auto until = std::chrono::steady_clock::now() + kWaitForPage;
  while (server_->pages() == 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace palpate::cli
