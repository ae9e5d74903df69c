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
#include <fstream>

int main(int argc, char** argv) {
  namespace sms = CGAL::Surface_mesh_simplification;
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  Mesh mesh;
  std::ifstream in(argc == 3 ? argv[1] : "", std::ios::binary);
  if (!in || !CGAL::IO::read_PLY(in, mesh)) {
    std::fprintf(stderr, "usage: bench_collapse MESH.ply TRIANGLES\n");
    return 2;
  }
  // Three edges for two faces: the ratio is the same.
  const double ratio = std::atof(argv[2]) / static_cast<double>(mesh.number_of_faces());
  const std::clock_t start = std::clock();
  sms::edge_collapse(mesh, sms::Count_ratio_stop_predicate<Mesh>(ratio));
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  mesh.collect_garbage();
  std::printf("%zu triangles, %.2f s of processor time\n",
              static_cast<std::size_t>(mesh.number_of_faces()), seconds);
  return 0;
}
