// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/packets.hpp"

#include "hal/protocol/bytes.hpp"
#include "hal/protocol/crc32.hpp"
#include "hal/text_table.hpp"

namespace palpate::hal::protocol {
namespace {

constexpr std::uint8_t kMagic[2] = {'P', 'p'};
constexpr std::size_t kTypeAt = 3;
constexpr std::size_t kSequenceAt = 4;
constexpr std::size_t kBodyAt = 8;
constexpr std::size_t kCrcAt = kPacketBytes - 4;
constexpr std::uint16_t kEnableFlag = 1;

/// Writes fields one after another; what is left of the packet stays zero.
class Writer {
 public:
  Writer(PacketType type, std::uint32_t sequence) noexcept {
    put(packet_, 0, kMagic[0]);
    put(packet_, 1, kMagic[1]);
    put(packet_, 2, kVersion);
    put(packet_, kTypeAt, static_cast<std::uint8_t>(type));
    put(packet_, kSequenceAt, sequence);
  }

  template <class T>
  Writer& add(T value) noexcept {
    put(packet_, at_, value);
    at_ += sizeof(T);
    return *this;
  }
  template <class T, std::size_t kCount>
  Writer& add(const std::array<T, kCount>& values) noexcept {
    for (const T value : values) add(value);
    return *this;
  }
  Writer& skip(std::size_t bytes) noexcept {
    at_ += bytes;
    return *this;
  }

  [[nodiscard]] Packet finish() noexcept {
    const auto body = std::span(packet_).first(kCrcAt);
    put(packet_, kCrcAt, ~crc32_update(kCrc32Start, body));
    return packet_;
  }

 private:
  Packet packet_{};
  std::size_t at_ = kBodyAt;
};

/// Reads fields one after another, remembering whether what has to be zero was.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  Reader& read(T& out) noexcept {
    out = get<T>(bytes_, at_);
    at_ += sizeof(T);
    return *this;
  }
  template <class T, std::size_t kCount>
  Reader& read(std::array<T, kCount>& out) noexcept {
    for (T& value : out) read(value);
    return *this;
  }
  Reader& zero(std::size_t bytes) noexcept {
    for (const std::size_t end = at_ + bytes; at_ < end; ++at_) {
      zeros_kept_ = zeros_kept_ && bytes_[at_] == std::byte{0};
    }
    return *this;
  }

  /// Everything up to the CRC was reserved; the verdict.
  PacketError finish(bool in_range) noexcept {
    zero(kCrcAt - at_);
    if (!zeros_kept_) return PacketError::reserved;
    return in_range ? PacketError::none : PacketError::range;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = kBodyAt;
  bool zeros_kept_ = true;
};

PacketType type_of(std::span<const std::byte> bytes) noexcept {
  return PacketType{get<std::uint8_t>(bytes, kTypeAt)};
}

std::uint32_t sequence_of(std::span<const std::byte> bytes) noexcept {
  return get<std::uint32_t>(bytes, kSequenceAt);
}

/// What every packet has in common. `other` may be the same type again.
PacketError check_frame(std::span<const std::byte> bytes, PacketType one,
                        PacketType other) noexcept {
  if (bytes.size() != kPacketBytes) return PacketError::size;
  if (get<std::uint8_t>(bytes, 0) != kMagic[0] || get<std::uint8_t>(bytes, 1) != kMagic[1]) {
    return PacketError::magic;
  }
  if (get<std::uint8_t>(bytes, 2) != kVersion) return PacketError::version;
  if (type_of(bytes) != one && type_of(bytes) != other) return PacketError::type;
  const std::uint32_t crc = ~crc32_update(kCrc32Start, bytes.first(kCrcAt));
  return crc == get<std::uint32_t>(bytes, kCrcAt) ? PacketError::none : PacketError::crc;
}

bool is_nearly_unit(const std::array<std::int32_t, 4>& q) noexcept {
  // Components in 2^-15, so that the squares of any four fit; 2/1024 of the square is 1/1024 of the
  // length.
  constexpr std::int64_t kOne = std::int64_t{1} << 30;
  std::int64_t squared = 0;
  for (const std::int32_t component : q) {
    const std::int64_t c = component / (1 << 15);
    squared += c * c;
  }
  return squared > kOne - kOne / 512 && squared < kOne + kOne / 512;
}

bool is_dof(std::uint8_t dof) noexcept { return dof == 3 || dof == 6; }

bool is_in_range(const Capabilities& c) noexcept {
  constexpr std::uint32_t kMaxRate_Hz = 20'000;
  return is_dof(c.sensed_dof) && is_dof(c.rendered_dof) && c.joints <= kMaxJoints &&
         (c.slots == 0 || c.slots == 2) && c.rate_Hz >= 1 && c.rate_Hz <= kMaxRate_Hz &&
         c.max_life_us >= 1 && c.max_life_us <= kMaxCommandLife_us;
}

}  // namespace

const char* describe(PacketError error) noexcept {
  return text_in<PacketError>({{PacketError::none, "sound"},
                               {PacketError::size, "wrong size"},
                               {PacketError::magic, "not a packet of this protocol"},
                               {PacketError::version, "another version of the protocol"},
                               {PacketError::type, "another type of packet"},
                               {PacketError::crc, "damaged (CRC)"},
                               {PacketError::reserved, "a reserved byte is not zero"},
                               {PacketError::range, "a field is out of range"}},
                              error, "unknown");
}

Packet encode(const State& s) noexcept {
  Writer w(s.is_joint_state ? PacketType::joint_state : PacketType::pose_state, s.sequence);
  w.add(s.device_time_ns);
  if (s.is_joint_state) {
    w.add(s.joint_counts);
  } else {
    w.add(s.position_nm).add(s.orientation);
  }
  w.add(s.buttons).add(s.answered).add(s.health).add(static_cast<std::uint8_t>(s.mode));
  return w.skip(1).add(s.refused).finish();
}

PacketError decode(std::span<const std::byte> bytes, State& out) noexcept {
  const auto bad = check_frame(bytes, PacketType::pose_state, PacketType::joint_state);
  if (bad != PacketError::none) return bad;
  State s;
  s.is_joint_state = type_of(bytes) == PacketType::joint_state;
  s.sequence = sequence_of(bytes);
  Reader r(bytes);
  r.read(s.device_time_ns);
  if (s.is_joint_state) {
    r.read(s.joint_counts);
  } else {
    r.read(s.position_nm).read(s.orientation);
  }
  std::uint8_t mode = 0;
  r.read(s.buttons).read(s.answered).read(s.health).read(mode).zero(1).read(s.refused);
  s.mode = Mode{mode};
  const bool known = s.health <= kKnownHealth && s.mode <= Mode::fault;
  const auto verdict = r.finish(known && (s.is_joint_state || is_nearly_unit(s.orientation)));
  if (verdict == PacketError::none) out = s;
  return verdict;
}

Packet encode(const Command& c) noexcept {
  Writer w(c.is_joint_command ? PacketType::joint_command : PacketType::wrench_command, c.sequence);
  w.add(c.life_us).add(c.enable ? kEnableFlag : std::uint16_t{0}).skip(2);
  if (c.is_joint_command) {
    w.add(c.joint_torque_uNm);
  } else {
    w.add(c.force_uN).add(c.torque_uNm).skip(4);
  }
  return w.add(c.answers).add(c.state_age_us).finish();
}

PacketError decode(std::span<const std::byte> bytes, Command& out) noexcept {
  const auto bad = check_frame(bytes, PacketType::wrench_command, PacketType::joint_command);
  if (bad != PacketError::none) return bad;
  Command c;
  c.is_joint_command = type_of(bytes) == PacketType::joint_command;
  c.sequence = sequence_of(bytes);
  std::uint16_t flags = 0;
  Reader r(bytes);
  r.read(c.life_us).read(flags).zero(2);
  if (c.is_joint_command) {
    r.read(c.joint_torque_uNm);
  } else {
    r.read(c.force_uN).read(c.torque_uNm).zero(4);
  }
  r.read(c.answers).read(c.state_age_us);
  c.enable = flags == kEnableFlag;
  const auto verdict =
      r.finish(flags <= kEnableFlag && c.life_us >= 1 && c.life_us <= kMaxCommandLife_us);
  if (verdict == PacketError::none) out = c;
  return verdict;
}

Packet encode(const Capabilities& c) noexcept {
  Writer w(PacketType::capabilities, 0);
  w.add(c.sensed_dof).add(c.rendered_dof).add(c.joints).add(c.slots);
  w.add(c.rate_Hz).add(c.max_force_uN).add(c.max_torque_uNm).add(c.max_life_us);
  return w.add(c.max_state_age_us).add(c.image_capacity_bytes).add(c.engine_memory_bytes).finish();
}

PacketError decode(std::span<const std::byte> bytes, Capabilities& out) noexcept {
  const auto bad = check_frame(bytes, PacketType::capabilities, PacketType::capabilities);
  if (bad != PacketError::none) return bad;
  Capabilities c;
  Reader r(bytes);
  r.read(c.sensed_dof).read(c.rendered_dof).read(c.joints).read(c.slots).read(c.rate_Hz);
  r.read(c.max_force_uN).read(c.max_torque_uNm).read(c.max_life_us);
  r.read(c.max_state_age_us).read(c.image_capacity_bytes).read(c.engine_memory_bytes);
  const auto verdict = r.finish(sequence_of(bytes) == 0 && is_in_range(c));
  if (verdict == PacketError::none) out = c;
  return verdict;
}

Packet encode(const Joint& j) noexcept {
  Writer w(PacketType::joint, j.index);
  w.add(j.a_nm).add(j.d_nm).add(j.alpha).add(j.theta_offset).add(j.counts_per_turn);
  return w.add(j.zero_counts).add(j.min_counts).add(j.max_counts).add(j.max_torque_uNm).finish();
}

PacketError decode(std::span<const std::byte> bytes, Joint& out) noexcept {
  const auto bad = check_frame(bytes, PacketType::joint, PacketType::joint);
  if (bad != PacketError::none) return bad;
  Joint j;
  const std::uint32_t index = sequence_of(bytes);
  Reader r(bytes);
  r.read(j.a_nm).read(j.d_nm).read(j.alpha).read(j.theta_offset).read(j.counts_per_turn);
  r.read(j.zero_counts).read(j.min_counts).read(j.max_counts).read(j.max_torque_uNm);
  j.index = static_cast<std::uint8_t>(index);
  const auto verdict =
      r.finish(index < kMaxJoints && j.counts_per_turn != 0 && j.min_counts <= j.max_counts);
  if (verdict == PacketError::none) out = j;
  return verdict;
}

Packet encode(const ImageIdentity& i) noexcept {
  Writer w(PacketType::image_identity, 0);
  w.add(i.active_slot).add(static_cast<std::uint8_t>(i.confirmed ? 1 : 0)).add(i.format_major);
  return w.add(i.image_bytes).add(i.sequence).add(i.content_sha256).finish();
}

PacketError decode(std::span<const std::byte> bytes, ImageIdentity& out) noexcept {
  const auto bad = check_frame(bytes, PacketType::image_identity, PacketType::image_identity);
  if (bad != PacketError::none) return bad;
  ImageIdentity i;
  std::uint8_t confirmed = 0;
  Reader r(bytes);
  r.read(i.active_slot).read(confirmed).read(i.format_major).read(i.image_bytes);
  r.read(i.sequence).read(i.content_sha256);
  i.confirmed = confirmed == 1;
  const bool slot_known = i.active_slot <= 1 || i.active_slot == kNoSlot;
  const auto verdict = r.finish(sequence_of(bytes) == 0 && confirmed <= 1 && slot_known);
  if (verdict == PacketError::none) out = i;
  return verdict;
}

}  // namespace palpate::hal::protocol
