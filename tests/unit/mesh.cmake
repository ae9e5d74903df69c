# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  foreach(part read triangulate check repair crossings cracks hostile)
    palpate_test(mesh_${part}_test SOURCES unit/mesh_${part}.cpp LIBS bodies_support)
  endforeach()
  palpate_test(mesh_commands_test SOURCES unit/mesh_commands.cpp LIBS palpate_bake)
  target_compile_definitions(mesh_commands_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  add_dependencies(mesh_commands_test palpate)
endif()
