// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate report`: one HTML file from a sweep, a replay or a run (docs/REPORT.md).
#include <algorithm>
#include <memory>
#include <string>

#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/report_contacts.hpp"
#include "tools/palpate/report_input.hpp"
#include "tools/palpate/report_json.hpp"
#include "tools/palpate/report_mcap.hpp"
#include "tools/palpate/report_page.hpp"
#include "tools/palpate/trace_file.hpp"

namespace palpate::cli {
namespace {

struct ReportArguments {
  std::string source, output, mcap;
  ReportHints hints;
  bool no_view = false, quiet = false;
};

ShownContacts contacts_of(const ReportInput& input, const Frames& frames,
                          const bake::Progress& show) {
  const ReportScene& view = *input.view;
  return view.contacts.empty() ? replay_shown_contacts(view, frames, show)
                               : read_shown_contacts(view, input.lines[view.contacts_of], frames);
}

void write_page(const ReportArguments& a) {
  const std::filesystem::path page = report_page();  // before any work is done
  ReportInput input = read_report_input(a.source, a.hints);
  if (a.no_view) input.view.reset();
  const bake::Progress show = progress(a.quiet);
  const std::size_t ticks = input.lines.empty() ? 1 : input.lines.front().ticks.size();
  nlohmann::ordered_json view;
  if (input.view) {
    const Frames frames = frames_of(ticks);
    view = view_json(*input.view, contacts_of(input, frames, show), frames);
    view["frames"] = frames_json(input, frames);
    if (frames.stride > 1) {
      input.notes.push_back("Of " + std::to_string(ticks) + " ticks one in " +
                            std::to_string(frames.stride) + " is a frame of the 3D view.");
    }
  }
  const std::size_t lines = std::max<std::size_t>(input.lines.size(), 1);
  nlohmann::ordered_json data = report_json(input, plot_frames_of(ticks, lines));
  data["view"] = std::move(view);
  write_file(a.output, fill_page(page, data));
}

void run(const ReportArguments& a) {
  if (a.output.empty() && a.mcap.empty()) {
    throw Failure(kUsage, "nothing to write", a.source, "give -o REPORT.html or --mcap FILE.mcap");
  }
  if (!a.mcap.empty()) {
    if (std::filesystem::is_directory(a.source)) {
      throw Failure(kUsage, "only the trace of a run becomes MCAP", a.source,
                    "give the file that 'palpate run -o' wrote");
    }
    write_mcap(read_trace(a.source), a.hints.scene, a.mcap, a.quiet);
  }
  if (!a.output.empty()) write_page(a);
}

}  // namespace

void add_report(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "report",
      "Show a sweep, a replay or a run: one HTML file that needs no network; or a run as MCAP");
  const auto a = std::make_shared<ReportArguments>();
  command
      ->add_option("SOURCE", a->source,
                   "folder of a sweep, folder with the tables of replays, or trace of a run")
      ->required();
  command->add_option("-o,--output", a->output, "write the report (HTML)")
      ->check(named_as(".html"));
  command->add_option("--mcap", a->mcap, "write the trace as MCAP, for Foxglove")
      ->check(named_as(".mcap"));
  command->add_option("--scene", a->hints.scene,
                      "scene for the 3D view, where the source does not say it");
  command->add_option("--poses", a->hints.poses,
                      "poses for the 3D view, where the source does not say it");
  command->add_flag("--no-view", a->no_view, "leave out the 3D view");
  command->add_flag("--quiet", a->quiet, "print no progress");
  command->callback([a] { run(*a); });
}

}  // namespace palpate::cli
