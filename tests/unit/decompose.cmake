# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(hull_test SOURCES unit/hull_convex.cpp unit/hull_growing.cpp
    LIBS bodies_support)
  palpate_test(mesh_normalise_test SOURCES unit/mesh_normalise.cpp LIBS bodies_support)
  palpate_test(decompose_test SOURCES unit/decompose_patches.cpp LIBS bodies_support)
endif()
