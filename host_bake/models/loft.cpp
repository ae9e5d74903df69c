// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/loft.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate::bake {
namespace {

constexpr std::size_t kSamplesV = 512;  // steps between the curves that are measured
constexpr std::size_t kSamplesU = 64;   // chords of one curve
constexpr double kQuantum_m = 0x1p-35;
constexpr double kEquilateral = 0.8660254037844386;  // height of a triangle of side 1

double distance(const Point& a, const Point& b) {
  const double x = a[0] - b[0];
  const double y = a[1] - b[1];
  const double z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

/// Sizes of a surface at kSamplesV + 1 even steps of v.
struct Measure {
  std::vector<double> along;   ///< mean length across the curves from v0 to here
  std::vector<double> around;  ///< length of the curve
  double area = 0;
};

Measure measure(const Surface& surface, double v0, double v1) {
  Measure m;
  std::vector<Point> before(kSamplesU);
  std::vector<Point> here(kSamplesU);
  for (std::size_t i = 0; i <= kSamplesV; ++i) {
    const double share = static_cast<double>(i) / kSamplesV;
    const Curve curve = surface(v0 + (v1 - v0) * share);
    double around = 0.0;
    double step = 0.0;
    for (std::size_t k = 0; k < kSamplesU; ++k) {
      here[k] = curve(static_cast<double>(k) / kSamplesU);
    }
    for (std::size_t k = 0; k < kSamplesU; ++k) {
      around += distance(here[k], here[(k + 1) % kSamplesU]);
      if (i > 0) step += distance(here[k], before[k]) / kSamplesU;
    }
    if (i > 0) m.area += step * 0.5 * (around + m.around.back());
    m.along.push_back(i > 0 ? m.along.back() + step : 0.0);
    m.around.push_back(around);
    before.swap(here);
  }
  return m;
}

/// The place, in steps of the measure, where `length` along the surface is reached.
double step_at(const Measure& m, double length) {
  const auto above = std::upper_bound(m.along.begin() + 1, m.along.end() - 1, length);
  const auto i = static_cast<std::size_t>(above - m.along.begin()) - 1;
  const double step = m.along[i + 1] - m.along[i];
  return static_cast<double>(i) + (step > 0.0 ? (length - m.along[i]) / step : 0.0);
}

/// Shift of a row against the one before: the middles of the edges of both, whose order decides the
/// diagonals, then keep the greatest possible distance from each other, so that no quad comes near
/// to having two equal diagonals.
double next_shift(const Row& before, std::uint32_t count) {
  if (before.count == 1) return 0.0;
  const double apart = 0.5 / static_cast<double>(std::lcm<std::uint64_t>(before.count, count));
  const double shift = before.shift + 0.5 / before.count - 0.5 / count + apart;
  return shift - std::floor(shift);
}

double snapped(double x) { return std::floor(x / kQuantum_m + 0.5) * kQuantum_m; }

/// A row of the mesh under construction.
struct Ring {
  std::uint32_t first;
  std::uint32_t count;
  double shift;
  [[nodiscard]] std::uint32_t vertex(std::int64_t i) const {
    const auto n = static_cast<std::int64_t>(count);
    return first + static_cast<std::uint32_t>(((i % n) + n) % n);
  }
  [[nodiscard]] double middle(std::int64_t edge) const {
    return shift + (static_cast<double>(edge) + 0.5) / count;
  }
};

/// Merges the edges of both rings in the order of their middles.
void zip(const Ring& a, const Ring& b, std::vector<Face>& out_faces) {
  const std::int64_t a_edges = a.count == 1 ? 0 : a.count;
  const std::int64_t b_edges = b.count == 1 ? 0 : b.count;
  // Ring b starts with the first edge whose middle lies beyond that of a's last edge, one turn
  // back.
  const double start = a_edges == 0 ? 0.0 : a.middle(-1);
  const auto b_first =
      b_edges == 0 ? 0 : static_cast<std::int64_t>(std::floor((start - b.shift) * b.count + 0.5));
  std::int64_t i = 0;
  std::int64_t j = b_first;
  while (i < a_edges || j < b_first + b_edges) {
    const bool advance_a = j == b_first + b_edges || (i < a_edges && a.middle(i) < b.middle(j));
    if (advance_a) {
      out_faces.push_back({a.vertex(i), a.vertex(i + 1), b.vertex(j)});
      ++i;
    } else {
      out_faces.push_back({a.vertex(i), b.vertex(j + 1), b.vertex(j)});
      ++j;
    }
  }
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const Face& f : mesh.faces) {
    const Point& a = mesh.points[f[0]];
    const Point& b = mesh.points[f[1]];
    const Point& c = mesh.points[f[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6.0;
}

}  // namespace

std::vector<Row> plan_rows(const Surface& surface, double v0, double v1, std::size_t vertices,
                           Last last) {
  const Measure m = measure(surface, v0, v1);
  const double edge = std::sqrt(m.area / static_cast<double>(vertices) / kEquilateral);
  const double wanted_rows = m.along.back() / (edge * kEquilateral);
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::floor(wanted_rows + 0.5)));

  std::vector<Row> plan(rows);
  std::vector<double> length(rows, 0.0);  // of the rings; a pole has none
  double total = 0.0;
  for (std::size_t k = 0; k < rows; ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(rows);
    const double step = step_at(m, m.along.back() * share);
    plan[k].v = k + 1 == rows ? v1 : v0 + (v1 - v0) * step / kSamplesV;
    if (k + 1 == rows && last == Last::pole) break;
    const auto i = std::min(static_cast<std::size_t>(step), kSamplesV - 1);
    length[k] = m.around[i] + (m.around[i + 1] - m.around[i]) * (step - static_cast<double>(i));
    total += length[k];
  }

  const auto ring_vertices = static_cast<double>(vertices) - (last == Last::pole ? 1.0 : 0.0);
  double due = 0.0;
  double given = 0.0;
  Row before;
  for (std::size_t k = 0; k < rows; ++k) {
    if (k + 1 < rows || last == Last::ring) {
      // Rounding the running sum, not the rows, makes the total exact.
      due += ring_vertices * length[k] / total;
      const double count = std::max(3.0, std::floor(due + 0.5) - given);
      given += count;
      plan[k].count = static_cast<std::uint32_t>(count);
      plan[k].shift = next_shift(before, plan[k].count);
    }
    before = plan[k];
  }
  return plan;
}

std::vector<Row> plan_body(const Surface& surface, double v0, double v1, std::size_t vertices) {
  std::vector<Row> rows{{v0, 1, 0.0}};
  append(rows, plan_rows(surface, v0, v1, vertices - 1, Last::pole));
  return rows;
}

void append(std::vector<Row>& rows, std::span<const Row> more) {
  rows.insert(rows.end(), more.begin(), more.end());
}

Mesh loft(const Surface& surface, std::span<const Row> rows, Ends ends) {
  Mesh mesh;
  std::vector<Ring> rings;
  for (const Row& row : rows) {
    rings.push_back({static_cast<std::uint32_t>(mesh.points.size()), row.count, row.shift});
    const Curve curve = surface(row.v);
    for (std::uint32_t i = 0; i < row.count; ++i) {
      const Point p = curve(row.shift + static_cast<double>(i) / row.count);
      mesh.points.push_back({snapped(p[0]), snapped(p[1]), snapped(p[2])});
    }
  }
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) zip(rings[k], rings[k + 1], mesh.faces);
  if (ends == Ends::joined) zip(rings.back(), rings.front(), mesh.faces);
  if (volume(mesh) < 0.0) {
    for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  }
  return mesh;
}

}  // namespace palpate::bake
