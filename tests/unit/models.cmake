# SPDX-License-Identifier: GPL-3.0-or-later
find_package(CGAL REQUIRED)
add_library(models_geometry STATIC unit/models_geometry.cpp)
target_include_directories(models_geometry PUBLIC "${PROJECT_SOURCE_DIR}")
target_link_libraries(models_geometry PUBLIC palpate_bake PRIVATE palpate_flags CGAL::CGAL)

palpate_test(models_test
  TOGETHER SOURCES unit/models_parts.cpp unit/models_shape.cpp unit/models_pairs.cpp LIBS models_geometry)
palpate_test(models_default_test LABEL long SOURCES unit/models_default.cpp LIBS models_geometry)

palpate_test(models_command_test SOURCES unit/models_command.cpp LIBS palpate_cli)
