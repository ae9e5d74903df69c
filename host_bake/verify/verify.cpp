// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {

std::vector<Proof> verify(const ImageView& image) {
  const Evidence evidence = gather(image);
  return {prove_sources_complete(evidence),
          prove_levels_are_surfaces(evidence),
          prove_interior_edges_convex(evidence),
          prove_no_vertex_visible(evidence),
          prove_no_intrusion(evidence),
          prove_hulls_covered(evidence),
          prove_hull_vertices_extreme(evidence),
          prove_adjacency(evidence),
          prove_spheres_contain(evidence),
          prove_free_levels_enclose(evidence),
          prove_hausdorff_bounds(evidence),
          prove_deviation_bounds(evidence),
          prove_deviation_ordered(evidence),
          prove_resolution_ordered(evidence),
          prove_support_areas_positive(evidence),
          prove_region_triangles(evidence),
          prove_region_neighbours(evidence),
          prove_patch_normals(evidence),
          prove_surface_vertices(evidence),
          prove_vertex_hulls(evidence),
          prove_pseudonormals(evidence),
          prove_concave_normals(evidence),
          prove_surface_edges(evidence),
          prove_region_cones(evidence),
          prove_proximity(evidence)};
}

}  // namespace palpate::bake
