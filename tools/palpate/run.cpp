// SPDX-License-Identifier: GPL-3.0-or-later
// palpate run: the real-time loop against a device.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tools/palpate/command.hpp"
#include "tools/palpate/device_choice.hpp"
#include "tools/palpate/error_line.hpp"
#include "tools/palpate/fault_words.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/live_view.hpp"
#include "tools/palpate/query_stack.hpp"
#include "tools/palpate/run_device.hpp"
#include "tools/palpate/run_summary.hpp"
#include "tools/palpate/scene_engine.hpp"
#include "tools/palpate/stable_scene.hpp"
#include "tools/palpate/start.hpp"
#include "tools/realtime/device_axes.hpp"
#include "tools/realtime/loop.hpp"
#include "tools/realtime/realtime_thread.hpp"
#include "tools/realtime/trace_writer.hpp"

namespace palpate::cli {
namespace {

/// Ticks that the disk may stand still for: 8 s at 1 kHz.
constexpr std::size_t kTelemetryRecords = 8192;
constexpr std::chrono::milliseconds kWatchEvery(50);

struct RunOptions {
  std::string scene;
  std::string device = "mock";
  std::optional<double> seconds;
  std::optional<double> rate_Hz;
  std::filesystem::path firmware;
  std::filesystem::path poses;  ///< empty: the scene's [[mock.path]]
  std::string trace;
  bool view = false;            ///< a live page
  std::uint16_t view_port = 0;  ///< 0: any
  bool no_browser = false;
  realtime::RealtimeOptions realtime;
  bool json = false;
  bool quiet = false;
};

std::atomic<bool> g_stop{false};

/// Ctrl-C ends the run with its summary for as long as this lives; a second one ends the process.
class StopOnSignal {
 public:
  StopOnSignal() {
    g_stop = false;
    struct sigaction action {};
    action.sa_handler = [](int) { g_stop = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, &old_interrupt_);
    sigaction(SIGTERM, &action, &old_terminate_);
  }
  ~StopOnSignal() {
    sigaction(SIGINT, &old_interrupt_, nullptr);
    sigaction(SIGTERM, &old_terminate_, nullptr);
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  StopOnSignal(StopOnSignal&&) = delete;
  StopOnSignal& operator=(StopOnSignal&&) = delete;

 private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
};

realtime::LoopSettings loop_settings(const RunOptions& options, const config::Scene& scene,
                                     double rate_Hz, const hal::Capabilities& device) {
  realtime::LoopSettings settings;
  settings.rate_Hz = rate_Hz;
  settings.query_time = {scene.budget_us, scene.reserve_us};
  settings.passivity_control = scene.passivity_control;
  if (options.seconds) {
    settings.periods = static_cast<std::uint64_t>(std::llround(*options.seconds * rate_Hz));
  }
  // Both times are for a loop of a haptic rate; a slow one for trying things out needs longer.
  const double two_periods_s = 2.0 / rate_Hz;
  settings.command_life_s = std::max(settings.command_life_s, two_periods_s);
  settings.safety.stale_after_s = std::max(settings.safety.stale_after_s, two_periods_s);
  settings.safety.connect_within_s = std::max(settings.safety.connect_within_s, two_periods_s);
  settings.safety.max_force_N = scene.settings.max_force_N;
  settings.safety.max_torque_Nm = scene.settings.max_torque_Nm;
  settings.safety.max_force_slew_N_per_s = scene.max_force_slew_N_per_s;
  settings.safety.max_torque_slew_Nm_per_s = scene.max_torque_slew_Nm_per_s;
  settings.safety.max_power_W = scene.max_power_W;
  realtime::fit_to(device, scene.bodies[scene.tool].pose.orientation, settings);
  return settings;
}

/// Of the device and the hand on it, where it is known.
std::optional<double> damping(const RunOptions& options, const config::Scene& scene) {
  if (scene.device_damping_N_s_per_m || !is_mock_hand(options.device)) {
    return scene.device_damping_N_s_per_m;
  }
  return scene.hand.damping_N_s_per_m;
}

/// The contact queries on a thread of their own, where the scene asks for one; below the loop,
/// which does not wait for it.
class ServerThread {
 public:
  ServerThread(const RunOptions& options, const config::Scene& scene,
               realtime::ContactServer* server, hal::Clock& clock) {
    if (server == nullptr) return;
    realtime::RealtimeOptions realtime = options.realtime;
    realtime.fifo_priority = std::max(realtime.fifo_priority - 2, 0);
    realtime.cpu = -1;
    const realtime::ServerSettings settings{*scene.contact_rate_Hz,
                                            {scene.budget_us, scene.reserve_us}};
    thread_.emplace(realtime,
                    [this, settings, server, &clock] { server->run(settings, clock, stop_); });
  }
  ~ServerThread() {
    stop_ = true;
    if (thread_) thread_->join();
  }
  ServerThread(const ServerThread&) = delete;
  ServerThread& operator=(const ServerThread&) = delete;
  ServerThread(ServerThread&&) = delete;
  ServerThread& operator=(ServerThread&&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::optional<realtime::RealtimeThread> thread_;
};

/// Runs the loop to its end, telling how far it has come, and stops the device.
realtime::HostGrant drive(const RunOptions& options, const realtime::LoopSettings& settings,
                          realtime::Loop& loop, hal::Device& device) {
  const StopOnSignal stop_on_signal;
  const bake::Progress show = progress(options.quiet);
  realtime::RealtimeThread thread(options.realtime, [&loop] { loop.run(g_stop); });
  while (!thread.finished()) {
    std::this_thread::sleep_for(kWatchEvery);
    if (!options.seconds) continue;
    show("run", static_cast<double>(loop.periods_passed()) / static_cast<double>(settings.periods));
  }
  realtime::HostGrant grant = thread.join();
  device.stop();
  return grant;
}

/// A file given by the user cannot be written.
template <class Function>
auto writing(const std::string& target, Function function) {
  try {
    return function();
  } catch (const std::system_error& e) {
    throw Failure(kOther, e.what(), target, "give a place that exists, is writable and has room");
  }
}

/// A fault has ended the rendering: whose it was.
Exit exit_of(realtime::FaultSet faults) {
  using realtime::Fault;
  const bool of_device = faults.has(Fault::stale_state) || faults.has(Fault::bad_state) ||
                         faults.has(Fault::device_error) || faults.has(Fault::not_homed);
  return of_device ? kDevice : faults.empty() ? kDone : kOther;
}

void report(const RunOptions& options, const RunOutcome& outcome) {
  if (options.json) {
    std::cout << run_json(outcome).dump(2) << "\n";
  } else {
    std::cout << run_text(outcome);
  }
  const bool kept = broken_promises(outcome).empty();
  set_exit(kept ? exit_of(outcome.report.faults) : kPromiseBroken);
  if (!kept || outcome.report.faults.empty()) return;
  for (const FaultNote& note : fault_notes(outcome.report)) {
    if (note.fault.empty()) continue;
    print_error("palpate", note.cause + ": " + options.device + ", tick " +
                               std::to_string(note.tick) + ": " + note.fix);
    return;
  }
}

/// A recorded motion takes the place of the scene's path, and is played once unless told how long.
void take_poses(RunOptions& options, config::Scene& scene) {
  if (options.poses.empty()) return;
  if (options.device != "mock") {
    throw Failure(kUsage, "only the mock hand plays a motion", "--poses",
                  "leave it out, or use --device mock");
  }
  scene.hand.path = hand_path(options.poses, scene);
  const double length_s = scene.hand.path.back().t_s;
  if (!options.seconds && length_s > 0) options.seconds = length_s;
}

/// What surprises whoever does not know it.
void tell_of_start(const RunOptions& options, const config::Scene& scene, SceneEngine& engine) {
  if (options.quiet) return;
  const bool mock = options.device == "mock";
  if (mock && scene.hand.path.empty()) {
    std::cerr << "The mock hand stands still: --poses FILE moves it, or [[mock.path]] in "
              << options.scene << ".\n";
  }
  const std::string overlap = overlap_line(scene, engine, mock);
  if (!overlap.empty()) std::cerr << "Note: " << overlap << ".\n";
}

/// The mouse is a page's.
void check_mouse(const RunOptions& options) {
  if (options.device == "mouse" && !options.view) {
    throw Failure(kUsage, "the mouse leads the hand in the live view", "--device mouse",
                  "add --view");
  }
}

void run(RunOptions options) {
  check_mouse(options);
  config::Scene scene = config::load_scene(options.scene);
  take_poses(options, scene);
  const double rate_Hz = options.rate_Hz.value_or(scene.rate_Hz);
  hal::MonotonicClock clock;
  const StableScene stable = stable_scene(scene, rate_Hz, damping(options, scene));
  if (!stable.note.empty() && !options.quiet) std::cerr << stable.note << "\n";
  SceneEngine engine(stable.scene);
  tell_of_start(options, scene, engine);
  const RunDevice made =
      make_run_device({options.device, options.firmware, options.realtime.fifo_priority, rate_Hz},
                      stable.scene, engine, clock);
  hal::Device* const device = made.device.get();
  std::unique_ptr<LiveView> view;
  if (options.view) {
    view = std::make_unique<LiveView>(
        stable.scene, LiveViewOptions{options.view_port, !options.no_browser, options.device,
                                      rate_Hz, made.lead});
  }
  QueryStack queries(stable.scene, engine.engine(), engine.start_poses(), rate_Hz,
                     view ? view->contacts() : ContactTap{});
  if (const auto problem = device->open()) fail(options.device, *problem);

  const auto settings = loop_settings(options, scene, rate_Hz, device->capabilities());
  hal::Ring<realtime::TraceRecord> ring(options.trace.empty() ? 0 : kTelemetryRecords);
  std::unique_ptr<realtime::TraceWriter> trace;
  if (!options.trace.empty()) {
    trace = writing(options.trace, [&] {
      return std::make_unique<realtime::TraceWriter>(options.trace, scene.file, rate_Hz, ring);
    });
  }
  const auto loop = std::make_unique<realtime::Loop>(settings, *device, queries.top(), clock,
                                                     trace ? &ring : nullptr,
                                                     view ? &view->tap().records : nullptr);
  if (parse_device(options.device).kind == "falcon" && !options.quiet) {
    std::cerr << "Pull the grip all the way out, then push it all the way in.\n";
  }
  if (view) view->announce();
  if (const auto problem = device->start()) fail(options.device, *problem);

  RunOutcome outcome;
  const ServerThread server(options, stable.scene, queries.server(), clock);
  outcome.grant = drive(options, settings, *loop, *device);
  if (view) view->end();
  outcome.scene = scene.file;
  outcome.device = options.device;
  outcome.rate_Hz = rate_Hz;
  outcome.budget_us = scene.budget_us;
  outcome.report = loop->report();
  if (queries.server() != nullptr) outcome.contacts_late = queries.server()->late();
  if (trace) {
    writing(options.trace, [&] { trace->commit(); });
    outcome.trace = options.trace;
    outcome.telemetry_dropped = ring.dropped();
  }
  report(options, outcome);
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run the real-time loop against a device");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command
      ->add_option("--device", options->device,
                   "mock, mouse (with --view), spacemouse, usb[:SERIAL], falcon[:SERIAL] or "
                   "tcp:HOST[:PORT] (USB/IP, as palpate-sim serves it)")
      ->check(is_device())
      ->capture_default_str();
  command->add_option("--firmware", options->firmware,
                      "falcon: the maker's firmware file; absent: it runs already");
  command->add_option("--seconds", options->seconds, "how long; absent: until Ctrl-C")
      ->check(CLI::Range(0.001, 1e7));
  command->add_option("--rate", options->rate_Hz, "ticks a second; absent: the scene's")
      ->check(CLI::Range(1.0, 20000.0));
  command->add_option("--poses", options->poses,
                      "motion of the mock hand (POSES.csv), in place of the scene's [[mock.path]]; "
                      "it starts over where --seconds is longer");
  CLI::Option* const view = command->add_flag(
      "--view{0}", options->view_port,
      "show the run in a page of this machine while it goes on; --view=PORT: at this port");
  view->check(CLI::Range(0, 65535));
  command->add_flag("--no-browser", options->no_browser, "with --view: only say the address");
  command->add_option("-o,--output", options->trace, "write a record of each tick to this file")
      ->check(named_as(".trace"));
  command
      ->add_option("--priority", options->realtime.fifo_priority,
                   "SCHED_FIFO priority of the loop; 0: an ordinary thread")
      ->check(CLI::Range(0, realtime::kMaxFifoPriority))
      ->capture_default_str();
  command->add_option("--cpu", options->realtime.cpu, "keep the loop on this processor")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->callback([options, view] {
    options->view = view->count() > 0;
    run(*options);
  });
}

}  // namespace palpate::cli
