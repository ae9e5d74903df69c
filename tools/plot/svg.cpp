// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/svg.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

namespace palpate::plot {
namespace {

constexpr double kWidth = 760, kHeight = 270;                        // of a panel
constexpr double kLeft = 70, kRight = 190, kTop = 30, kBottom = 45;  // around its axes
// Okabe and Ito's palette, which colour-blind readers can tell apart.
constexpr std::array<const char*, 8> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#F0E442", "#777777"};

/// Pixels: a tenth of one is enough.
std::string px(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 1).ptr};
}

/// A number beside an axis.
std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

/// One axis: from values to pixels.
struct Scale {
  double low = 0, high = 1, from_px = 0, to_px = 1;
  bool log = false;

  [[nodiscard]] bool has(double v) const { return std::isfinite(v) && (!log || v > 0); }
  [[nodiscard]] double at(double v) const {
    const double share = log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
    return from_px + share * (to_px - from_px);
  }
};

/// 1, 2 or 5 times a power of ten, about a fifth of the range.
double step_of(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 5)));
  const double times = range / 5 / power;
  return power * (times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1);
}

/// Whole decades, or whole steps.
void widen(Scale& s) {
  if (s.log) {
    s.low = std::pow(10.0, std::floor(std::log10(s.low)));
    s.high = std::pow(10.0, std::ceil(std::log10(s.high)));
    if (s.high <= s.low) s.high = 10 * s.low;
    return;
  }
  if (s.low > 0) s.low = 0;
  if (s.high <= s.low) s.high = s.low + 1;
  const double step = step_of(s.high - s.low);
  s.low = step * std::floor(s.low / step);
  s.high = step * std::ceil(s.high / step);
}

std::vector<double> ticks_of(const Scale& s) {
  std::vector<double> out;
  if (s.log) {
    for (double v = s.low; v <= 1.0001 * s.high; v *= 10) out.push_back(v);
  } else {
    const double step = step_of(s.high - s.low);
    const auto count = std::lround((s.high - s.low) / step);
    for (long i = 0; i <= count; ++i) out.push_back(s.low + double(i) * step);
  }
  return out;
}

Scale scale_of(const Panel& panel, const Axis& axis, bool is_x) {
  Scale s;
  s.log = axis.log;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Series& series : panel.series) {
    for (const auto& [x, y] : series.points) {
      const double v = is_x ? x : y;
      if (!s.has(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  s.low = low <= high ? low : axis.log ? 1.0 : 0.0;
  s.high = low <= high ? high : s.low + 1;
  widen(s);
  return s;
}

std::string text_at(double x, double y, const char* more, const std::string& content) {
  return "<text x='" + px(x) + "' y='" + px(y) + "' " + more + ">" + escaped(content) + "</text>\n";
}

void draw_axes(const Panel& panel, const Scale& x, const Scale& y, std::string& out) {
  constexpr const char* kMiddle = "text-anchor='middle'";
  for (const double v : ticks_of(x)) {
    out += "<path class='g' d='M" + px(x.at(v)) + " " + px(y.from_px) + "V" + px(y.to_px) + "'/>";
    out += text_at(x.at(v), y.from_px + 15, kMiddle, label(v));
  }
  for (const double v : ticks_of(y)) {
    out += "<path class='g' d='M" + px(x.from_px) + " " + px(y.at(v)) + "H" + px(x.to_px) + "'/>";
    out += text_at(x.from_px - 6, y.at(v) + 4, "text-anchor='end'", label(v));
  }
  out += text_at((x.from_px + x.to_px) / 2, y.from_px + 33, kMiddle, panel.x.title);
  out += text_at(x.from_px, y.to_px - 10, "font-weight='bold'", panel.title);
  out += "<g transform='translate(14 " + px((y.from_px + y.to_px) / 2) + ") rotate(-90)'>" +
         text_at(0, 0, kMiddle, panel.y.title) + "</g>\n";
}

void draw_series(const Series& series, const std::string& colour, const Scale& x, const Scale& y,
                 std::string& out) {
  std::string path;
  for (const auto& [u, v] : series.points) {
    if (!x.has(u) || !y.has(v)) continue;
    const std::string at_x = px(x.at(u)), at_y = px(y.at(v));
    if (series.mark == Mark::point) {
      out.append("<circle cx='").append(at_x).append("' cy='").append(at_y);
      out.append("' r='3.5' fill='").append(colour).append("'/>\n");
    } else {
      path.append(path.empty() ? "M" : "L").append(at_x).append(" ").append(at_y);
    }
  }
  if (path.empty()) return;
  out += "<path fill='none' stroke-width='1.3' stroke='" + colour + "' d='" + path + "'/>\n";
}

void draw_legend(const Panel& panel, double left, double top, std::string& out) {
  double y = top + 6;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    if (series.name.empty()) continue;
    out += "<rect x='" + px(left) + "' y='" + px(y - 9) + "' width='10' height='10' fill='" +
           kColours[i % kColours.size()] + "'/>";
    out += text_at(left + 15, y, "", series.name);
    y += 17;
  }
}

void draw(const Panel& panel, double top, std::string& out) {
  Scale x = scale_of(panel, panel.x, true);
  Scale y = scale_of(panel, panel.y, false);
  x.from_px = kLeft;
  x.to_px = kWidth - kRight;
  y.from_px = top + kHeight - kBottom;
  y.to_px = top + kTop;
  draw_axes(panel, x, y, out);
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    draw_series(panel.series[i], kColours[i % kColours.size()], x, y, out);
  }
  draw_legend(panel, x.to_px + 12, y.to_px, out);
}

}  // namespace

std::string to_svg(std::span<const Panel> panels) {
  const std::string height = label(kHeight * double(panels.size()));
  std::string out = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + label(kWidth) + " " +
                    height + "' width='" + label(kWidth) + "' height='" + height + "' ";
  out +=
      "font-family='sans-serif' font-size='12'>\n"
      "<style>text{fill:#777}.g{stroke:#777;stroke-opacity:.25;fill:none}</style>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) draw(panels[i], kHeight * double(i), out);
  return out + "</svg>\n";
}

}  // namespace palpate::plot
