// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/replay_csv.hpp"

#include <charconv>
#include <cmath>

namespace palpate::cli {
namespace {

/// Appends comma-separated fields to a text.
class Row {
 public:
  explicit Row(std::string& out) : out_(out) {}
  ~Row() { out_.back() = '\n'; }  // in place of the last comma
  Row(const Row&) = delete;
  Row& operator=(const Row&) = delete;

  template <class Number>
  Row& operator<<(Number value) {
    char text[32];
    out_.append(text, std::to_chars(text, text + sizeof text, value).ptr).push_back(',');
    return *this;
  }
  Row& operator<<(Vec3d v) { return *this << v.x << v.y << v.z; }
  Row& operator<<(bool) = delete;  // say which number stands for it
  Row& empty() {
    out_.push_back(',');
    return *this;
  }

 private:
  std::string& out_;
};

}  // namespace

std::string ticks_csv(std::span<const TickRow> rows) {
  std::string out = std::string(kTicksHeader) + "\n";
  for (std::size_t tick = 0; tick < rows.size(); ++tick) {
    const TickRow& r = rows[tick];
    Row row(out);
    row << tick << r.t_s << r.wrench.force_N << r.wrench.torque_Nm << r.contacts << r.clusters;
    if (std::isnan(r.min_distance_m)) {
      row.empty();
    } else {
      row << r.min_distance_m;
    }
    row << r.front_nodes << r.queries << r.time_ns << (r.certificate.truncated() ? 1 : 0)
        << r.certificate.s_worst << r.certificate.error_bound_m;
  }
  return out;
}

std::string contact_rows(std::span<const ContactRow> rows) {
  std::string out;
  for (const ContactRow& r : rows) {
    const Contact& c = r.contact;
    Row(out) << r.tick << c.pair << c.point_a_m << c.point_b_m << c.normal << c.distance_m
             << c.piece_a << c.level_a << c.piece_b << c.level_b << c.weight;
  }
  return out;
}

}  // namespace palpate::cli
