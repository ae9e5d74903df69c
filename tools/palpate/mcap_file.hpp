// SPDX-License-Identifier: GPL-3.0-or-later
// Writes MCAP, the recording format of Foxglove (https://mcap.dev/spec, version 0): indexed chunks
// without compression, JSON messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/protocol/crc32.hpp"
#include "tools/palpate/output_file.hpp"

namespace palpate::cli {

class McapFile {
 public:
  /// Begins the file. The output must outlive this; whoever owns it commits it after finish().
  /// All members throw Failure(kOther) where it cannot be written.
  explicit McapFile(OutputFile& out);

  /// @param schema_name, json_schema  of its messages; a schema is shared by name
  /// @return its number, for add()
  std::uint16_t add_channel(std::string_view topic, std::string_view schema_name,
                            std::string_view json_schema);

  /// One message. @param time_ns  since an epoch of the writer's choice; any order, but readers
  /// like ascending ones
  void add(std::uint16_t channel, std::uint64_t time_ns, std::string_view json);

  /// Ends the file: last chunk, summary, footer. Once, last.
  void finish();

 private:
  using Index = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< time, place in the chunk
  void write(std::string_view bytes);
  void end_chunk();
  void write_summary();

  OutputFile& out_;
  std::uint64_t written_ = 0;
  std::uint32_t crc_ = hal::kCrc32Start;  ///< of all that is written, or of the summary
  std::map<std::string, std::uint16_t, std::less<>> schemas_;
  std::string schema_records_, channel_records_, chunk_index_records_;
  std::string chunk_;  ///< records of the chunk that is being filled
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0;
  std::uint64_t start_ns_ = 0, end_ns_ = 0;
  std::map<std::uint16_t, Index> index_;  ///< of the chunk, by channel
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint32_t chunks_ = 0;
  std::uint16_t channels_ = 0;
};

}  // namespace palpate::cli
