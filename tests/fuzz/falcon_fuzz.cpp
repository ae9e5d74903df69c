// SPDX-License-Identifier: Apache-2.0
// Hostile bytes into the Falcon's stream: whatever is taken for a reply encodes to bytes that stood
// in the stream, and two sound replies after the noise bring at least one.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/falcon/ftdi.hpp"
#include "hal/falcon/kinematics.hpp"
#include "hal/falcon/messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace palpate::hal::falcon {
namespace {

void check(std::span<const std::byte> bytes) {
  std::vector<std::byte> transfer(bytes.begin(), bytes.end());
  const std::size_t payload = strip_status(transfer);
  ReplyParser parser;
  std::vector<std::byte> seen;
  for (std::size_t i = 0; i < payload; ++i) {
    seen.push_back(transfer[i]);
    if (parser.feed(std::span(transfer).subspan(i, 1)) == 0) continue;
    Message tail;
    std::copy(seen.end() - kMessageBytes, seen.end(), tail.begin());
    Reply reply;
    if (!decode(tail, reply) || reply.counts != parser.newest().counts) __builtin_trap();
    Vec3d position_m;
    static_cast<void>(forward(angles_of(reply.counts), position_m));
  }
  const Message good = encode(Reply{{1, -2, 3}, 5, 7});
  if (parser.feed(good) + parser.feed(good) == 0) __builtin_trap();
  if (parser.newest().counts != EncoderCounts{1, -2, 3}) __builtin_trap();
}

}  // namespace
}  // namespace palpate::hal::falcon

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::hal::falcon::check(std::as_bytes(std::span(data, size)));
  return 0;
}
