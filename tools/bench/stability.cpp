// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stable stiffness over hands, rates and encoders, beside the bound: docs/STABILITY.md.
// Usage: bench_stability OUT.png OUT.csv
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "tools/bench/pressed_wall.hpp"
#include "tools/picture/png.hpp"
#include "tools/picture/raster.hpp"
#include "tools/picture/text.hpp"

namespace palpate::bench {
namespace {

using picture::Raster;
using picture::Rgb;

constexpr std::array kMass_kg{0.1, 0.3, 1.0};
constexpr std::array kDamping_N_s_per_m{0.0, 0.5, 2.0, 5.0};
constexpr std::array kGrip_N_per_m{10.0, 100.0, 1000.0};
constexpr std::array kRate_Hz{500.0, 1000.0, 2000.0, 4000.0, 10000.0};
constexpr std::array kBits{16, 18, 20};

struct Point {
  PressedWall wall;
  double largest_N_per_m;
};

std::vector<Point> map_of(Felt felt, bool control) {
  std::vector<Point> out;
  for (const double rate : kRate_Hz)
    for (const double damping : kDamping_N_s_per_m)
      for (const double mass : kMass_kg)
        for (const double grip : kGrip_N_per_m)
          for (const int bits : kBits) {
            const PressedWall w{mass, damping, grip, rate, bits, felt, control, 0};
            out.push_back({w, largest_stable_stiffness(w)});
          }
  return out;
}

// The picture: a square a panel, both axes logarithmic, in pixels of a raster that is shrunk later.

constexpr int kShrink = 2, kSide = 640, kMargin = 90, kDot = 5, kScale = 3;
constexpr double kLeastShown = 100, kMostShown = 1e5;
constexpr Rgb kGrey{215, 215, 215}, kBound{90, 90, 90};
constexpr std::array<Rgb, kRate_Hz.size()> kColours{
    {{200, 40, 40}, {230, 140, 20}, {60, 160, 60}, {40, 110, 200}, {130, 60, 170}}};

/// Where a stiffness lies along an axis; all less than the least shown at its beginning.
double along(double stiffness_N_per_m) {
  const double shown = std::clamp(stiffness_N_per_m, kLeastShown, kMostShown);
  return kSide * std::log(shown / kLeastShown) / std::log(kMostShown / kLeastShown);
}

void fill(Raster& r, double left, double top, double right, double bottom, Rgb colour) {
  const picture::Paint paint{colour, colour};
  const picture::Corner a{left, top, 0}, b{right, top, 0}, c{right, bottom, 0}, d{left, bottom, 0};
  // Nearness counts up, so that what is drawn later is seen.
  static double nearness = 0;
  nearness += 1;
  std::array<picture::Corner, 3> first{a, b, c}, second{a, c, d};
  for (auto* corners : {&first, &second})
    for (picture::Corner& corner : *corners) corner.nearness = nearness;
  picture::fill_triangle(r, first, paint);
  picture::fill_triangle(r, second, paint);
}

void draw_axes(Raster& r, const char* title) {
  for (double decade = kLeastShown; decade <= kMostShown; decade *= 10) {
    const double at = along(decade);
    fill(r, kMargin + at - 1, kMargin, kMargin + at + 1, kMargin + kSide, kGrey);
    fill(r, kMargin, kMargin + kSide - at - 1, kMargin + kSide, kMargin + kSide - at + 1, kGrey);
    const std::string label = "1e" + std::to_string(std::lround(std::log10(decade)));
    picture::draw_text(r, kMargin + static_cast<int>(at) - 25, kMargin + kSide + 12, kScale, label);
    picture::draw_text(r, 20, kMargin + kSide - static_cast<int>(at) - 12, kScale, label);
  }
  for (double v = kLeastShown; v < kMostShown; v *= 1.005) {  // where largest and bound are equal
    const double at = along(v);
    fill(r, kMargin + at - 2, kMargin + kSide - at - 2, kMargin + at + 2, kMargin + kSide - at + 2,
         kBound);
  }
  picture::draw_text(r, kMargin, 30, kScale, title);
}

Raster panel(const std::vector<Point>& points, const char* title) {
  Raster r(kSide + 2 * kMargin, kSide + 2 * kMargin);
  draw_axes(r, title);
  for (const Point& p : points) {
    const auto rate = std::find(kRate_Hz.begin(), kRate_Hz.end(), p.wall.rate_Hz);
    const auto index = static_cast<std::size_t>(rate - kRate_Hz.begin());
    // Rates stand beside each other where bounds of several coincide.
    const double x = kMargin + along(passive_stiffness(p.wall)) + 6.0 * static_cast<double>(index);
    const double y = kMargin + kSide - along(p.largest_N_per_m);
    fill(r, x - kDot, y - kDot, x + kDot, y + kDot, kColours[index]);
  }
  return r;
}

void draw_legend(Raster& r, int top) {
  int left = kMargin;
  for (std::size_t i = 0; i < kRate_Hz.size(); ++i) {
    fill(r, left, top, left + 24, top + 24, kColours[i]);
    picture::draw_text(r, left + 34, top, kScale, std::to_string(std::lround(kRate_Hz[i])) + " hz");
    left += 230;
  }
}

void write_csv(std::ofstream& out, const std::vector<Point>& points) {
  for (const Point& p : points) {
    const PressedWall& w = p.wall;
    out << (w.felt == Felt::direct ? "direct" : "virtual") << ',' << w.passivity_control << ','
        << w.rate_Hz << ',' << w.damping_N_s_per_m << ',' << w.mass_kg << ',' << w.grip_N_per_m
        << ',' << w.encoder_bits << ',' << p.largest_N_per_m << ',' << passive_stiffness(w) << '\n';
  }
}

/// A row of docs/STABILITY.md: the least and the median of largest stiffness over bound.
void print_row(const char* title, const std::vector<Point>& points) {
  std::vector<double> ratios;
  for (const Point& p : points)
    if (p.wall.damping_N_s_per_m > 0) {
      ratios.push_back(p.largest_N_per_m / passive_stiffness(p.wall));
    }
  std::sort(ratios.begin(), ratios.end());
  std::printf("| %s | %zu | %.2f | %.2f | %.1f |\n", title, ratios.size(), ratios.front(),
              ratios[ratios.size() / 20], ratios[ratios.size() / 2]);
}

void run(const char* picture_file, const char* csv_file) {
  struct Kind {
    Felt felt;
    bool control;
    const char* title;
  };
  constexpr std::array kinds{Kind{Felt::direct, false, "direct"},
                             Kind{Felt::direct, true, "direct, passivity control"},
                             Kind{Felt::coupled, false, "virtual"},
                             Kind{Felt::coupled, true, "virtual, passivity control"}};
  constexpr int kPanel = kSide + 2 * kMargin, kLegend = 80;
  Raster all(2 * kPanel, 2 * kPanel + kLegend);
  std::ofstream csv(csv_file);
  csv << "coupling,passivity_control,rate_Hz,damping_N_s_per_m,mass_kg,grip_N_per_m,encoder_bits,"
         "largest_N_per_m,bound_N_per_m\n";
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::vector<Point> points = map_of(kinds[i].felt, kinds[i].control);
    const int column = static_cast<int>(i % 2), row = static_cast<int>(i / 2);
    picture::paste(all, panel(points, kinds[i].title), column * kPanel, row * kPanel);
    write_csv(csv, points);
    print_row(kinds[i].title, points);
  }
  draw_legend(all, 2 * kPanel + 20);
  const std::vector<std::byte> bytes = picture::to_png(picture::shrink(all, kShrink));
  std::ofstream out(picture_file, std::ios::binary);
  for (const std::byte b : bytes) out.put(static_cast<char>(b));
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: bench_stability OUT.png OUT.csv\n", stderr);
    return 2;
  }
  try {
    palpate::bench::run(argv[1], argv[2]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
