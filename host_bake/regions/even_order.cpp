// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/even_order.hpp"

#include <cmath>
#include <limits>

#include "host_bake/base/parallel.hpp"

namespace palpate::bake {

std::vector<std::uint32_t> even_order(std::span<const Vec3d> points, double near) {
  const std::size_t n = points.size();
  const auto potential = [near](Vec3d a, Vec3d b) {
    return 1 / std::sqrt(squared_norm(a - b) + near * near);
  };
  std::vector<double> of_all(n);  // means
  parallel_for(n, [&](std::size_t i) {
    double sum = 0;
    for (const Vec3d& p : points) sum += potential(points[i], p);
    of_all[i] = sum / static_cast<double>(n);
  });
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> places(n, kNone);
  std::vector<double> of_beginning(n);  // sums
  for (std::uint32_t place = 0; place < n; ++place) {
    std::size_t next = n;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double wanted = of_all[i] - of_beginning[i] / (place + 1.0);
      if (places[i] == kNone && wanted > most) {
        most = wanted;
        next = i;
      }
    }
    places[next] = place;
    for (std::size_t i = 0; i < n; ++i) of_beginning[i] += potential(points[i], points[next]);
  }
  return places;
}

}  // namespace palpate::bake
