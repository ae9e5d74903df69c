// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate run --view`: the page that shows a run while it goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "config/scene.hpp"
#include "tools/live/feed.hpp"
#include "tools/palpate/browser.hpp"
#include "tools/palpate/query_stack.hpp"

namespace palpate::cli {

struct LiveViewOptions {
  std::uint16_t port = 0;  ///< 0: any free one
  bool browser = true;     ///< open it where there is a screen; else only say where it is
  std::string device;      ///< as the user named it
  double rate_Hz = 1000;
  std::function<void(const hal::mock::Lead&)>
      lead;  ///< told where a page wants the tool; empty: none may
};

class LiveView {
 public:
  /// Serves from now on. Throws Failure: kOther where this build has no page or the port cannot be
  /// had; kRefused for an image, as SceneEngine does.
  LiveView(const config::Scene& scene, LiveViewOptions options);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;
  LiveView(LiveView&&) = delete;
  LiveView& operator=(LiveView&&) = delete;

  /// What the loop writes to.
  [[nodiscard]] realtime::LiveTap& tap() { return *tap_; }
  [[nodiscard]] ContactTap contacts() { return {&tap_->ticks, origin_m_}; }

  /// Says the address on stderr. Where it opens a browser, waits for the page, some seconds at
  /// most.
  void announce();

  /// The run is over: each page gets a last frame. The tap stays.
  void end();

 private:
  std::unique_ptr<realtime::LiveTap> tap_;
  Vec3d origin_m_;
  bool browser_;
  std::unique_ptr<live::Feed> feed_;
  std::unique_ptr<live::Server> server_;
  std::optional<Signpost> signpost_;
};

}  // namespace palpate::cli
