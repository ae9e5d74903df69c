// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's own edge collapse (default cost and placement), as a yardstick for bake times:
//   bench_collapse MESH.ply TRIANGLES
// prints the triangles left and the processor seconds that it took, reading excluded.
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>

namespace {

int measure(const char* file, double triangles) {
  namespace sms = CGAL::Surface_mesh_simplification;
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  Mesh mesh;
  std::ifstream in(file, std::ios::binary);
  if (!in || !CGAL::IO::read_PLY(in, mesh)) return 3;
  // Three edges for two faces: the ratio is the same.
  const double ratio = triangles / static_cast<double>(mesh.number_of_faces());
  const std::clock_t start = std::clock();
  sms::edge_collapse(mesh, sms::Count_ratio_stop_predicate<Mesh>(ratio));
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  mesh.collect_garbage();
  std::printf("%zu triangles, %.2f s of processor time\n",
              static_cast<std::size_t>(mesh.number_of_faces()), seconds);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 3) return measure(argv[1], std::strtod(argv[2], nullptr));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_collapse: %s\n", e.what());
    return 1;
  }
  std::fputs("usage: bench_collapse MESH.ply TRIANGLES\n", stderr);
  return 2;
}
