// SPDX-License-Identifier: Apache-2.0
// The packet decoders and both ends of the protocol against hostile bytes, with the CRC made right
// on every other run. What a decoder takes must encode to the same bytes.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "hal/protocol/bytes.hpp"
#include "hal/protocol/crc32.hpp"
#include "hal/protocol/device_end.hpp"
#include "hal/protocol/host_end.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace palpate::hal::protocol {
namespace {

template <class T>
void check(std::span<const std::byte> bytes) {
  T value;
  if (decode(bytes, value) != PacketError::none) return;
  const Packet again = encode(value);
  if (std::memcmp(again.data(), bytes.data(), kPacketBytes) != 0) __builtin_trap();
}

void check_all(std::span<const std::byte> bytes) {
  check<State>(bytes);
  check<Command>(bytes);
  check<Capabilities>(bytes);
  check<Joint>(bytes);
  check<ImageIdentity>(bytes);
}

Capabilities limits() {
  Capabilities c;
  c.rate_Hz = 1000;
  c.max_force_uN = 5'000'000;
  c.max_torque_uNm = 100'000;
  c.max_life_us = 20'000;
  c.max_state_age_us = 10'000;
  return c;
}

void talk(std::span<const std::byte> bytes) {
  DeviceEnd device(limits());
  HostEnd host(limits());
  device.begin_session();
  std::uint64_t now_ns = 1;
  for (std::size_t at = 0; at + kPacketBytes <= bytes.size(); at += kPacketBytes) {
    Packet packet;
    std::memcpy(packet.data(), bytes.data() + at, kPacketBytes);
    put(std::span<std::byte>(packet), kPacketBytes - 4,
        ~crc32_update(kCrc32Start, std::span<const std::byte>(packet).first(kPacketBytes - 4)));
    check_all(packet);
    DeviceState reading;
    static_cast<void>(host.receive(packet, now_ns, reading));
    device.receive(packet, now_ns);
    State out;
    device.stamp(out);
    now_ns += 1'000'000;
    const Command& c = device.output(now_ns);
    for (const std::int32_t f : c.force_uN) {
      if (f > 5'000'000 || f < -5'000'000) __builtin_trap();
    }
  }
}

}  // namespace
}  // namespace palpate::hal::protocol

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  palpate::hal::protocol::check_all(bytes);
  palpate::hal::protocol::talk(bytes);
  return 0;
}
