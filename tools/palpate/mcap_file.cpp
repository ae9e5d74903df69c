// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/mcap_file.hpp"

#include <algorithm>
#include <span>

namespace palpate::cli {
namespace {

constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};
/// A chunk is what a reader loads to show one moment.
constexpr std::size_t kChunkBytes = 1u << 20;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f
};

/// The fields of a record, one after the other.
class McapFields {
 public:
  template <class Unsigned>
  McapFields& number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
    }
    return *this;
  }
  /// With its length before it, in 32 bits: strings, arrays, maps, and schemas.
  McapFields& text(std::string_view value) {
    return number(static_cast<std::uint32_t>(value.size())).raw(value);
  }
  McapFields& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(Opcode opcode, std::string_view content) {
  return McapFields()
      .number(static_cast<std::uint8_t>(opcode))
      .number(static_cast<std::uint64_t>(content.size()))
      .raw(content)
      .bytes();
}
std::string record(Opcode opcode, const McapFields& fields) {
  return record(opcode, fields.bytes());
}

std::uint32_t crc_after(std::uint32_t state, std::string_view bytes) {
  return hal::crc32_update(state, std::as_bytes(std::span(bytes)));
}

}  // namespace

McapFile::McapFile(OutputFile& out) : out_(out) {
  write(kMcapMagic);
  write(record(kHeader, McapFields().text("").text("palpate " PALPATE_VERSION)));
}

void McapFile::write(std::string_view bytes) {
  out_.append(bytes);
  crc_ = crc_after(crc_, bytes);
  written_ += bytes.size();
}

std::uint16_t McapFile::add_channel(std::string_view topic, std::string_view schema_name,
                                    std::string_view json_schema) {
  auto schema = schemas_.find(schema_name);
  if (schema == schemas_.end()) {
    const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
    schema = schemas_.emplace(schema_name, id).first;
    const McapFields fields =
        McapFields().number(id).text(schema_name).text("jsonschema").text(json_schema);
    schema_records_ += record(kSchema, fields);
    write(record(kSchema, fields));
  }
  const std::uint16_t channel = channels_++;
  const std::string bytes =
      record(kChannel,
             McapFields().number(channel).number(schema->second).text(topic).text("json").text(""));
  channel_records_ += bytes;
  write(bytes);
  counts_[channel] = 0;
  return channel;
}

void McapFile::add(std::uint16_t channel, std::uint64_t time_ns, std::string_view json) {
  chunk_start_ns_ = chunk_.empty() ? time_ns : std::min(chunk_start_ns_, time_ns);
  chunk_end_ns_ = chunk_.empty() ? time_ns : std::max(chunk_end_ns_, time_ns);
  index_[channel].emplace_back(time_ns, chunk_.size());
  chunk_ += record(kMessage, McapFields()
                                 .number(channel)
                                 .number(static_cast<std::uint32_t>(counts_[channel]++))
                                 .number(time_ns)
                                 .number(time_ns)
                                 .raw(json));
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapFile::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t start = written_;
  const std::uint64_t size = chunk_.size();
  write(record(kChunk, McapFields()
                           .number(chunk_start_ns_)
                           .number(chunk_end_ns_)
                           .number(size)
                           .number(~crc_after(hal::kCrc32Start, chunk_))
                           .text("")
                           .number(size)
                           .raw(chunk_)));
  const std::uint64_t index_start = written_;
  McapFields offsets;
  for (const auto& [channel, entries] : index_) {
    McapFields times;
    for (const auto& [time_ns, place] : entries) times.number(time_ns).number(place);
    offsets.number(channel).number(written_);
    write(record(kMessageIndex, McapFields().number(channel).text(times.bytes())));
  }
  chunk_index_records_ += record(kChunkIndex, McapFields()
                                                  .number(chunk_start_ns_)
                                                  .number(chunk_end_ns_)
                                                  .number(start)
                                                  .number(index_start - start)
                                                  .text(offsets.bytes())
                                                  .number(written_ - index_start)
                                                  .text("")
                                                  .number(size)
                                                  .number(size));
  start_ns_ = chunks_ == 0 ? chunk_start_ns_ : std::min(start_ns_, chunk_start_ns_);
  end_ns_ = chunks_ == 0 ? chunk_end_ns_ : std::max(end_ns_, chunk_end_ns_);
  ++chunks_;
  chunk_.clear();
  index_.clear();
}

void McapFile::finish() {
  end_chunk();
  write(record(kDataEnd, McapFields().number(~crc_)));
  write_summary();
}

/// Groups of records of one kind, then where each group is, then the footer.
void McapFile::write_summary() {
  std::uint64_t messages = 0;
  McapFields per_channel;
  for (const auto& [channel, count] : counts_) {
    per_channel.number(channel).number(count);
    messages += count;
  }
  const std::string statistics =
      record(kStatistics, McapFields()
                              .number(messages)
                              .number(static_cast<std::uint16_t>(schemas_.size()))
                              .number(std::uint32_t{channels_})
                              .number(std::uint32_t{0})
                              .number(std::uint32_t{0})
                              .number(chunks_)
                              .number(start_ns_)
                              .number(end_ns_)
                              .text(per_channel.bytes()));
  const std::uint64_t summary_start = written_;
  crc_ = hal::kCrc32Start;
  std::string offsets;
  const auto group = [&](Opcode opcode, const std::string& records) {
    if (records.empty()) return;
    offsets += record(kSummaryOffset, McapFields()
                                          .number(static_cast<std::uint8_t>(opcode))
                                          .number(written_)
                                          .number(static_cast<std::uint64_t>(records.size())));
    write(records);
  };
  group(kSchema, schema_records_);
  group(kChannel, channel_records_);
  group(kStatistics, statistics);
  group(kChunkIndex, chunk_index_records_);
  const std::uint64_t offsets_start = written_;
  write(offsets);
  // The checksum goes up to its own place in the footer.
  const std::string before = McapFields().number(summary_start).number(offsets_start).bytes();
  const std::string footer = record(kFooter, McapFields().raw(before).number(std::uint32_t{0}));
  write(std::string_view(footer).substr(0, footer.size() - sizeof(std::uint32_t)));
  write(McapFields().number(~crc_).bytes());
  write(kMcapMagic);
}

}  // namespace palpate::cli
