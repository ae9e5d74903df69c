# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  foreach(part read triangulate check repair crossings hostile)
    palpate_test(mesh_${part}_test SOURCES unit/mesh_${part}.cpp unit/mesh_support.cpp LIBS palpate_bake)
  endforeach()
endif()
