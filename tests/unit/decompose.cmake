# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(hull_test SOURCES unit/hull_convex.cpp unit/hull_growing.cpp unit/hull_oracle.cpp
    LIBS palpate_bake)
  palpate_test(mesh_normalise_test SOURCES unit/mesh_normalise.cpp unit/decompose_shapes.cpp
    LIBS palpate_bake)
  palpate_test(decompose_test SOURCES unit/decompose_patches.cpp unit/decompose_shapes.cpp
    unit/decompose_oracle.cpp unit/hull_oracle.cpp LIBS palpate_bake)
endif()
