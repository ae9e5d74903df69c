// SPDX-License-Identifier: Apache-2.0
// The bits of both engines: wrenches, contacts and counts of a fixed motion under budgets in work
// units. They are the same for every compiler, optimisation and processor, and change only together
// with the engine.
//
//   engine_bits LEVELS REGIONS    images for either engine; prints what it found; exit status 1
//                                 where it is not what it has to be
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>
#include <span>

#include "rt_core/palpate_rt.hpp"

namespace palpate {
namespace {

struct Case {
  const char* name;
  Settings settings;
  std::uint64_t units;
  std::uint64_t hash;
  double pace = 1;  ///< of the motion
  std::uint64_t reserve_units = 0;
};

constexpr double kDelta_m = 0.05;
constexpr std::uint64_t kUnlimited = Budget{}.units;
const Case kCases[] = {
    {"exact", {.delta_m = kDelta_m, .exact = true}, kUnlimited, 0x1ef631eee32d0cfa},
    {"exact, 40 units", {.delta_m = kDelta_m, .exact = true}, 40, 0xd82cae44301129f9},
    {"exact, 40 units, by deviation",
     {.delta_m = kDelta_m, .exact = true, .order = Order::deviation},
     40,
     0x0bf9035c002172bb},
    {"simplified", {.delta_m = kDelta_m, .s0 = 0.02}, kUnlimited, 0xa41fd3195e34d4b5},
    {"simplified, 40 units", {.delta_m = kDelta_m, .s0 = 0.02}, 40, 0x702f5f850e2d11bd},
    {"paper's bounds",
     {.delta_m = kDelta_m, .s0 = 0.02, .bounds = Bounds::paper},
     200,
     0x029a865a77bb3c04},
    {"regions, exact",
     {.engine = EngineKind::regions, .delta_m = kDelta_m, .exact = true},
     kUnlimited,
     0xb2c2e00e60d33559},
    {"regions, 100 units",
     {.engine = EngineKind::regions, .delta_m = kDelta_m},
     100,
     0xd9b425bcedc145cf},
    {"regions, 60 units, slowly",
     {.engine = EngineKind::regions, .delta_m = kDelta_m},
     60,
     0x75487c59c77fe256,
     0.03},
    {"regions, 5 units and a reserve",
     {.engine = EngineKind::regions, .delta_m = kDelta_m},
     5,
     0x0e3b70be146c521b,
     1,
     kUnlimited},
    {"regions, tolerance",
     {.engine = EngineKind::regions, .delta_m = kDelta_m, .force_tolerance_N = 3},
     kUnlimited,
     0x5b167f750bec8e74},
};
constexpr int kTicks = 200;

/// FNV-1a (Fowler, Noll, Vo).
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int i = 0; i < 8; ++i) value_ = (value_ ^ ((bits >> (8 * i)) & 0xff)) * 0x100000001b3u;
  }
  void add(double v) { add(std::bit_cast<std::uint64_t>(v)); }
  void add(Vec3d v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Around the other body, in and out of contact; no function of the C library but sqrt.
Pose pose_of(double tick) {
  const double u = 0.02 * tick;
  const double wave = u - 2 * static_cast<double>(static_cast<int>(u / 2)) - 1;  // -1 to 1
  const double n = sqrt_of(1 + 0.09 * u * u + 0.25 * wave * wave);
  const Vec3d out{1, 0.2 * u, 0.3 * wave};
  const double reach = (2.0 + 0.08 * wave * wave) / norm(out);
  return {reach * out, {1 / n, 0.3 * u / n, 0, 0.5 * wave / n}};
}

struct Free {
  void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t{64}); }
};

/// As images and engines want it.
struct Memory {
  explicit Memory(std::size_t bytes)
      : owned(new (std::align_val_t{64}) std::byte[bytes]), size(bytes) {}
  [[nodiscard]] std::span<std::byte> bytes() const { return {owned.get(), size}; }

  std::unique_ptr<std::byte[], Free> owned;
  std::size_t size;
};

std::uint64_t hash_of(const ImageView& image, const Case& test) {
  const ImageView bodies[2] = {image, image};
  const BodyPair pairs[1] = {{0, 1}};
  const Scene scene{bodies, pairs, 0};
  const Limits limits{.nodes = 1u << 14, .contacts = 1u << 10, .clusters = 1u << 8};
  Engine* engine = nullptr;
  const Memory memory(required_bytes(scene, limits, test.settings.engine));
  if (create(scene, test.settings, limits, memory.bytes(), engine) != Status::ok) return 0;
  Hash hash;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {pose_of(test.pace * i), {}};
    TickResult r;
    const Budget budget{.units = test.units, .reserve_units = test.reserve_units};
    if (tick(*engine, poses, budget, r) != Status::ok) return 0;
    hash.add(r.wrench.force_N);
    hash.add(r.wrench.torque_Nm);
    hash.add(r.certificate.error_bound_m);
    hash.add(static_cast<std::uint64_t>(r.contacts.size()));
    for (const Contact& c : r.contacts) hash.add(c.distance_m);
    hash.add(r.queries);
    hash.add(r.front_nodes);
  }
  return hash.value();
}

bool open(const char* file, std::span<std::byte> room, ImageView& out) {
  std::FILE* in = std::fopen(file, "rb");
  if (in == nullptr) return false;
  const std::size_t size = std::fread(room.data(), 1, room.size(), in);
  std::fclose(in);
  return validate(room.first(size), out) == Status::ok;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const palpate::Memory of_levels(1u << 20);
  const palpate::Memory of_regions(1u << 20);
  palpate::ImageView levels;
  palpate::ImageView regions;
  if (argc != 3 || !palpate::open(argv[1], of_levels.bytes(), levels) ||
      !palpate::open(argv[2], of_regions.bytes(), regions)) {
    std::fputs("usage: engine_bits LEVELS REGIONS\n", stderr);
    return 2;
  }
  int failed = 0;
  for (const palpate::Case& test : palpate::kCases) {
    const bool by_levels = test.settings.engine == palpate::EngineKind::levels;
    const std::uint64_t found = palpate::hash_of(by_levels ? levels : regions, test);
    std::printf("%016llx %s\n", static_cast<unsigned long long>(found), test.name);
    if (found != test.hash) failed = 1;
  }
  return failed;
}
