// SPDX-License-Identifier: Apache-2.0
// One packet of each type with every field set, and readings and commands as devices and loops make
// them.
#pragma once

#include <cstdint>

#include "hal/protocol/packets.hpp"

namespace palpate::hal::protocol::test {

inline State some_state() {
  State s;
  s.sequence = 0x01020304;
  s.device_time_ns = 0x1112131415161718;
  s.position_nm = {1'000'000, -2'000'000, 2'000'000'000};
  s.orientation = {kUnitQuaternion / 5 * 4, 0, -(kUnitQuaternion / 5 * 3), 0};
  s.buttons = 0x80000001;
  s.answered = 77;
  s.health = kOverheated | kLimitReached;
  s.mode = Mode::active;
  s.refused = 5;
  return s;
}

inline State some_joint_state() {
  State s = some_state();
  s.is_joint_state = true;
  s.position_nm = {};
  s.orientation = {kUnitQuaternion, 0, 0, 0};
  s.joint_counts = {1, -2, 3, -4, 5, -6, 2'000'000'000};
  return s;
}

inline Command some_command() {
  Command c;
  c.sequence = 9;
  c.life_us = 20'000;
  c.enable = true;
  c.force_uN = {1'500'000, -2'500'000, 3};
  c.torque_uNm = {-10, 20, -30};
  c.answers = 0x01020304;
  c.state_age_us = 250;
  return c;
}

inline Command some_joint_command() {
  Command c = some_command();
  c.is_joint_command = true;
  c.force_uN = c.torque_uNm = {};
  c.joint_torque_uNm = {1, -2, 3, -4, 5, -6, 7};
  return c;
}

inline Capabilities some_capabilities() {
  Capabilities c;
  c.slots = 2;
  c.rate_Hz = 4000;
  c.max_force_uN = 20'000'000;
  c.max_torque_uNm = 1'000'000;
  c.max_life_us = 20'000;
  c.max_state_age_us = 10'000;
  c.image_capacity_bytes = 512 * 1024;
  c.engine_memory_bytes = 256 * 1024;
  return c;
}

inline Joint some_joint() {
  Joint j;
  j.index = 2;
  j.a_nm = 80'000'000;
  j.d_nm = -205'000'000;
  j.alpha = 1 << 30;
  j.theta_offset = -(1 << 29);
  j.counts_per_turn = -8000;
  j.zero_counts = 123;
  j.min_counts = -2000;
  j.max_counts = 2000;
  j.max_torque_uNm = 259'000;
  return j;
}

inline ImageIdentity some_identity() {
  ImageIdentity i;
  i.active_slot = 1;
  i.confirmed = true;
  i.format_major = 1;
  i.image_bytes = 0x00030040;
  i.sequence = 12;
  for (std::size_t k = 0; k < i.content_sha256.size(); ++k) {
    i.content_sha256[k] = static_cast<std::uint8_t>(k + 1);
  }
  return i;
}

}  // namespace palpate::hal::protocol::test
