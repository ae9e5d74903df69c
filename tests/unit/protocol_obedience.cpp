// SPDX-License-Identifier: Apache-2.0
// Devices that are asked for a force and render none.
#include <gtest/gtest.h>

#include <functional>

#include "../support/packets.hpp"
#include "../support/time.hpp"
#include "hal/protocol/host_end.hpp"

namespace palpate::hal::protocol {
namespace {

using hal::test::kMs;
using test::some_capabilities;

/// A device that is asked for a force in each millisecond, and what its readings say.
struct Asked {
  HostEnd host{some_capabilities()};
  DeviceState out;
  State s;
  std::uint64_t now_ns = 0;

  /// What is wrong after so many milliseconds of readings of this kind.
  std::uint32_t after_ms(int ms, const std::function<void(State&, std::uint32_t asked)>& answer) {
    DeviceCommand command;
    command.wrench.force_N.x = 1;
    command.answers = 1;
    for (int i = 0; i < ms; ++i) {
      now_ns += kMs;
      command.expires_ns = now_ns + 20 * kMs;
      Command sent;
      EXPECT_EQ(decode(host.command(command, now_ns), sent), PacketError::none);
      ++s.sequence;
      s.device_time_ns = now_ns;
      answer(s, sent.sequence);
      EXPECT_TRUE(host.receive(encode(s), now_ns, out));
    }
    return out.faults;
  }
};

void obey(State& s, std::uint32_t asked) {
  s.answered = asked - 1;  // the last one is still on its way
  s.mode = Mode::active;
}

TEST(Obedience, device_that_does_as_it_is_told_is_no_fault) {
  Asked asked;
  EXPECT_EQ(asked.after_ms(1000, obey), kNoDeviceFault);
}

TEST(Obedience, device_that_refuses_ignores_or_falls_idle_is_a_named_fault_within_50_ms) {
  struct Case {
    std::uint32_t fault;
    std::function<void(State&, std::uint32_t)> answer;
  };
  const std::vector<Case> cases = {{kDeviceRefuses,
                                    [](State& s, std::uint32_t) {
                                      s.mode = Mode::idle;
                                      ++s.refused;
                                    }},
                                   {kDeviceIgnores, [](State&, std::uint32_t) {}},
                                   {kDeviceIdle, [](State& s, std::uint32_t number) {
                                      s.mode = Mode::idle;
                                      s.answered = number;
                                    }}};
  for (const Case& c : cases) {
    Asked fresh;
    EXPECT_EQ(fresh.after_ms(50, c.answer), c.fault);
    Asked asked;
    EXPECT_EQ(asked.after_ms(100, obey), kNoDeviceFault);
    EXPECT_EQ(asked.after_ms(30, c.answer), kNoDeviceFault);
    EXPECT_EQ(asked.after_ms(1, obey), kNoDeviceFault);  // it goes on in time
    EXPECT_EQ(asked.after_ms(50, c.answer), c.fault);
    EXPECT_EQ(asked.after_ms(100, obey), c.fault);  // in this session it stays one
  }
}

TEST(Obedience, device_without_force_that_nobody_asks_for_one_is_no_fault) {
  Asked asked;
  EXPECT_EQ(asked.after_ms(100, obey), kNoDeviceFault);
  static_cast<void>(asked.host.no_force());
  for (int i = 0; i < 100; ++i) {
    ++asked.s.sequence;
    asked.s.device_time_ns = asked.now_ns += kMs;
    asked.s.mode = Mode::idle;
    ASSERT_TRUE(asked.host.receive(encode(asked.s), asked.now_ns, asked.out));
  }
  EXPECT_EQ(asked.out.faults, kNoDeviceFault);
}

TEST(Obedience, host_that_stood_still_does_not_blame_the_device) {
  Asked asked;
  EXPECT_EQ(asked.after_ms(100, obey), kNoDeviceFault);
  // A command on its way, and readings from before it that waited for the host for 60 ms.
  DeviceCommand command;
  command.wrench.force_N.x = 1;
  command.answers = 1;
  command.expires_ns = asked.now_ns + 20 * kMs;
  static_cast<void>(asked.host.command(command, asked.now_ns));
  const std::uint64_t arrival_ns = asked.now_ns + 60 * kMs;
  for (const std::uint64_t taken_ms : {1u, 2u, 59u}) {
    ++asked.s.sequence;
    asked.s.device_time_ns = asked.now_ns + taken_ms * kMs;
    ASSERT_TRUE(asked.host.receive(encode(asked.s), arrival_ns, asked.out));
    EXPECT_EQ(asked.out.faults, kNoDeviceFault);
  }
}

}  // namespace
}  // namespace palpate::hal::protocol
