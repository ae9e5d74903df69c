// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/trace_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;
using realtime::TraceHeader;
using realtime::TraceRecord;

// Records are copied as they lie in the file.
static_assert(std::endian::native == std::endian::little);

[[noreturn]] void refuse_trace(const std::string& what, const fs::path& file) {
  throw Failure(kRefused, what, file.string(),
                "give a trace that 'palpate run -o' wrote, or the folder of a sweep or a replay");
}

}  // namespace

Trace read_trace(const fs::path& file) {
  std::string bytes;
  if (const std::error_code error = config::read_text(file, bytes)) {
    refuse_trace("cannot read the trace (" + error.message() + ")", file);
  }
  Trace trace;
  TraceHeader& h = trace.header;
  if (bytes.size() < sizeof h) refuse_trace("not a trace", file);
  std::memcpy(&h, bytes.data(), sizeof h);
  if (h.magic != realtime::kTraceMagic) refuse_trace("not a trace", file);
  if (h.version != realtime::kTraceVersion || h.record_bytes != sizeof(TraceRecord)) {
    refuse_trace("a trace of another version", file);
  }
  const std::size_t room = bytes.size() - std::min<std::size_t>(bytes.size(), h.header_bytes);
  if (h.header_bytes < sizeof h || h.scene_bytes > h.header_bytes - sizeof h ||
      h.records != room / sizeof(TraceRecord) || room % sizeof(TraceRecord) != 0) {
    refuse_trace("a trace cut short", file);
  }
  if (h.records == 0) refuse_trace("a trace without ticks", file);
  trace.scene = bytes.substr(sizeof h, h.scene_bytes);
  trace.records.resize(h.records);
  std::memcpy(trace.records.data(), bytes.data() + h.header_bytes, room);
  return trace;
}

}  // namespace palpate::cli
