// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/trace_writer.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <system_error>

#include "tests/support/temporary_folder.hpp"

namespace palpate::realtime {
namespace {

TraceRecord record(std::uint64_t tick) {
  TraceRecord r;
  r.tick = tick;
  r.position_m = {0.5, static_cast<double>(tick), 0};
  return r;
}

TEST(TraceRecord, layout_is_the_documented_one) {
  EXPECT_EQ(offsetof(TraceHeader, records), 24u);
  EXPECT_EQ(offsetof(TraceHeader, rate_Hz), 40u);
  EXPECT_EQ(offsetof(TraceRecord, position_m), 16u);
  EXPECT_EQ(offsetof(TraceRecord, orientation), 40u);
  EXPECT_EQ(offsetof(TraceRecord, rendered_force_N), 72u);
  EXPECT_EQ(offsetof(TraceRecord, sent_force_N), 120u);
  EXPECT_EQ(offsetof(TraceRecord, min_distance_m), 144u);
  EXPECT_EQ(offsetof(TraceRecord, energy_J), 168u);
  EXPECT_EQ(offsetof(TraceRecord, latency_ns), 176u);
  EXPECT_EQ(offsetof(TraceRecord, front_nodes), 200u);
  EXPECT_EQ(offsetof(TraceRecord, state), 204u);
  EXPECT_EQ(offsetof(TraceRecord, faults), 206u);
}

TEST(TraceWriter, committed_file_holds_header_path_and_every_record) {
  const palpate::test::TemporaryFolder folder;
  constexpr std::uint64_t kRecords = 5000;
  hal::Ring<TraceRecord> ring(1u << 13);
  TraceWriter writer(folder.path() / "run.trace", "/somewhere/scene.toml", 1000, ring);
  for (std::uint64_t i = 0; i < kRecords; ++i) ring.push(record(i));
  writer.commit();

  const std::string bytes = palpate::test::read_file(folder.path() / "run.trace");
  TraceHeader header;
  ASSERT_GE(bytes.size(), sizeof header);
  std::memcpy(&header, bytes.data(), sizeof header);
  EXPECT_EQ(header.magic, kTraceMagic);
  EXPECT_EQ(header.version, kTraceVersion);
  EXPECT_EQ(header.records, kRecords);
  EXPECT_EQ(header.dropped, 0u);
  EXPECT_EQ(header.rate_Hz, 1000.0);
  EXPECT_EQ(header.header_bytes % 8, 0u);
  EXPECT_EQ(bytes.substr(sizeof header, header.scene_bytes), "/somewhere/scene.toml");
  ASSERT_EQ(bytes.size(), header.header_bytes + kRecords * header.record_bytes);
  for (const std::uint64_t i : {std::uint64_t(0), kRecords - 1}) {
    TraceRecord r;
    std::memcpy(&r, bytes.data() + header.header_bytes + i * header.record_bytes, sizeof r);
    EXPECT_EQ(r.tick, i);
    EXPECT_EQ(r.position_m[1], static_cast<double>(i));
  }
  EXPECT_EQ(folder.files(), 1u);
}

TEST(TraceWriter, without_commit_nothing_is_left) {
  const palpate::test::TemporaryFolder folder;
  hal::Ring<TraceRecord> ring(64);
  {
    TraceWriter writer(folder.path() / "run.trace", "scene.toml", 1000, ring);
    ring.push(record(1));
    EXPECT_EQ(folder.files(), 1u);
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(TraceWriter, dropped_records_are_in_the_header) {
  const palpate::test::TemporaryFolder folder;
  hal::Ring<TraceRecord> ring(2);
  for (std::uint64_t i = 0; i < 5; ++i) ring.push(record(i));
  TraceWriter writer(folder.path() / "run.trace", "scene.toml", 1000, ring);
  writer.commit();
  TraceHeader header;
  std::memcpy(&header, palpate::test::read_file(folder.path() / "run.trace").data(), sizeof header);
  EXPECT_EQ(header.records, 2u);
  EXPECT_EQ(header.dropped, 3u);
}

TEST(TraceWriter, impossible_target_is_an_error_before_the_run) {
  const palpate::test::TemporaryFolder folder;
  hal::Ring<TraceRecord> ring(2);
  EXPECT_THROW(TraceWriter(folder.path() / "none" / "run.trace", "s", 1000, ring),
               std::system_error);
  EXPECT_THROW(TraceWriter(folder.path(), "s", 1000, ring), std::system_error);
  EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace palpate::realtime
