// SPDX-License-Identifier: GPL-3.0-or-later
// What the summary of a run says about its faults.
#include "tools/palpate/fault_words.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tools/palpate/run_summary.hpp"

namespace palpate::cli {
namespace {

using realtime::Fault;

RunOutcome outcome_with(std::uint32_t device_faults, std::uint64_t tick) {
  RunOutcome outcome;
  outcome.device = "usb";
  outcome.rate_Hz = 1000;
  outcome.report.ticks = 5000;
  outcome.report.state = realtime::LoopState::fault;
  outcome.report.faults.add(Fault::device_error);
  outcome.report.fault_ticks.fill(tick);
  outcome.report.device_faults = device_faults;
  outcome.report.device_fault_ticks.fill(tick);
  return outcome;
}

TEST(FaultWords, every_fault_of_a_device_has_a_name_a_cause_and_a_fix_of_its_own) {
  std::set<std::string> names, causes;
  for (std::uint32_t i = 0; i < hal::kDeviceFaultKinds; ++i) {
    const auto notes = fault_notes(outcome_with(1u << i, 7).report);
    const FaultNote& note = notes.back();
    names.insert(note.device);
    causes.insert(note.cause);
    EXPECT_EQ(note.tick, 7u);
    EXPECT_FALSE(note.fix.empty());
  }
  EXPECT_EQ(names.size(), std::size_t{hal::kDeviceFaultKinds});
  EXPECT_EQ(causes.size(), std::size_t{hal::kDeviceFaultKinds});
  for (const char* name : {"unplugged", "motor_failure", "silenced", "refused"}) {
    EXPECT_EQ(names.count(name), 1u) << name;
  }
}

TEST(FaultWords, every_fault_of_the_loop_has_words) {
  for (std::uint8_t i = 0; i < realtime::kFaultCount; ++i) {
    realtime::LoopReport report;
    report.faults.add(Fault{i});
    const auto notes = fault_notes(report);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].fault, realtime::name(Fault{i}));
    EXPECT_FALSE(notes[0].cause.empty());
    EXPECT_FALSE(notes[0].fix.empty());
  }
}

TEST(FaultWords, what_came_first_stands_first) {
  RunOutcome outcome = outcome_with(hal::kDeviceLost, 9);
  outcome.report.faults.add(Fault::stale_state);
  outcome.report.fault_ticks[static_cast<std::size_t>(Fault::stale_state)] = 60;
  const auto notes = fault_notes(outcome.report);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].device, "unplugged");
  EXPECT_EQ(notes[1].fault, "stale_state");
}

TEST(FaultWords, kept_promises_are_not_praised_beside_a_fault) {
  const std::string text = run_text(outcome_with(hal::kDeviceLost, 1234));
  EXPECT_EQ(text.find("Every promise was kept"), std::string::npos) << text;
  EXPECT_NE(text.find("in tick 1,234: the device was unplugged"), std::string::npos) << text;
  EXPECT_NE(text.find("plug it in again"), std::string::npos) << text;
  EXPECT_NE(run_text(RunOutcome{}).find("Every promise was kept"), std::string::npos);
}

TEST(FaultWords, missed_deadlines_say_what_a_hand_feels_of_them) {
  RunOutcome outcome;
  outcome.report.missed = 3;
  EXPECT_EQ(run_text(outcome).find("a knock"), std::string::npos);  // of no force nothing
  outcome.report.force_N_max = 0.5;
  EXPECT_NE(run_text(outcome).find("a knock"), std::string::npos);
}

TEST(FaultWords, json_has_the_devices_words) {
  const auto j = run_json(outcome_with(hal::kDeviceRefuses, 3));
  EXPECT_EQ(j["device_faults"], nlohmann::json({"refused"}));
  ASSERT_EQ(j["fault_details"].size(), 1u);
  EXPECT_EQ(j["fault_details"][0]["fault"], "device_error");
  EXPECT_EQ(j["fault_details"][0]["device"], "refused");
  EXPECT_EQ(j["fault_details"][0]["tick"], 3);
}

}  // namespace
}  // namespace palpate::cli
