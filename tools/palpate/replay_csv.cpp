// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/replay_csv.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace palpate::cli {
namespace {

/// Appends comma-separated fields to a text.
class CsvRow {
 public:
  explicit CsvRow(std::string& out) : out_(out) {}
  ~CsvRow() { out_.back() = '\n'; }  // in place of the last comma
  CsvRow(const CsvRow&) = delete;
  CsvRow& operator=(const CsvRow&) = delete;

  template <class Number>
  CsvRow& operator<<(Number value) {
    char text[32];
    out_.append(text, std::to_chars(text, text + sizeof text, value).ptr).push_back(',');
    return *this;
  }
  CsvRow& operator<<(Vec3d v) { return *this << v.x << v.y << v.z; }
  CsvRow& operator<<(bool) = delete;  // say which number stands for it
  CsvRow& empty() {
    out_.push_back(',');
    return *this;
  }

 private:
  std::string& out_;
};

/// Takes the fields of one line one by one.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}

  template <class Number>
  Fields& operator>>(Number& value) {
    const std::string_view field = next();
    const char* const end = field.data() + field.size();
    const auto [stopped, error] = std::from_chars(field.data(), end, value);
    good_ = good_ && error == std::errc() && stopped == end;
    return *this;
  }
  Fields& operator>>(Vec3d& v) { return *this >> v.x >> v.y >> v.z; }

  /// An empty field is NaN.
  void optional(double& value) {
    if (rest_.starts_with(',')) {
      rest_.remove_prefix(1);
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      *this >> value;
    }
  }

  /// Whether every field was a number and none is left.
  [[nodiscard]] bool done() const { return good_ && at_end_; }

 private:
  std::string_view next() {
    good_ = good_ && !at_end_;
    const std::size_t comma = rest_.find(',');
    const std::string_view field = rest_.substr(0, comma);
    at_end_ = comma == std::string_view::npos;
    rest_.remove_prefix(at_end_ ? rest_.size() : comma + 1);
    return field;
  }

  std::string_view rest_;
  bool good_ = true, at_end_ = false;
};

bool read(std::string_view line, std::size_t expected_tick, TickRow& out) {
  Fields fields(line);
  std::size_t tick = 0;
  unsigned truncated = 0;
  fields >> tick >> out.t_s >> out.wrench.force_N >> out.wrench.torque_Nm >> out.contacts >>
      out.clusters;
  fields.optional(out.min_distance_m);
  fields >> out.front_nodes >> out.queries >> out.time_ns >> truncated >> out.certificate.s_worst >>
      out.certificate.error_bound_m >> out.certificate.force_bound_N;
  out.certificate.truncated_by_time = truncated != 0;
  if (out.contacts > 0) out.certificate.contact = ContactStatus::found;
  return fields.done() && tick == expected_tick;
}

}  // namespace

std::string ticks_csv(std::span<const TickRow> rows) {
  std::string out = std::string(kTicksHeader) + "\n";
  for (std::size_t tick = 0; tick < rows.size(); ++tick) {
    const TickRow& r = rows[tick];
    CsvRow row(out);
    row << tick << r.t_s << r.wrench.force_N << r.wrench.torque_Nm << r.contacts << r.clusters;
    if (std::isnan(r.min_distance_m)) {
      row.empty();
    } else {
      row << r.min_distance_m;
    }
    row << r.front_nodes << r.queries << r.time_ns << (r.certificate.truncated() ? 1 : 0)
        << r.certificate.s_worst << r.certificate.error_bound_m << r.certificate.force_bound_N;
  }
  return out;
}

std::optional<std::vector<TickRow>> ticks_from_csv(std::string_view text) {
  const std::string header = std::string(kTicksHeader) + "\n";
  if (!text.starts_with(header)) return std::nullopt;
  text.remove_prefix(header.size());
  std::vector<TickRow> rows;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const std::size_t tick = rows.size();
    if (!read(text.substr(0, end), tick, rows.emplace_back())) return std::nullopt;
    text.remove_prefix(end + 1);
  }
  return rows;
}

std::string contact_rows(std::span<const ContactRow> rows) {
  std::string out;
  for (const ContactRow& r : rows) {
    const Contact& c = r.contact;
    CsvRow(out) << r.tick << c.pair << c.point_a_m << c.point_b_m << c.normal << c.distance_m
                << c.piece_a << c.level_a << c.piece_b << c.level_b << c.weight;
  }
  return out;
}

}  // namespace palpate::cli
