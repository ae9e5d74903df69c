# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(bake_test THREADS
    SOURCES
      unit/bake_hierarchy.cpp unit/bake_metrics.cpp unit/bake_pack.cpp unit/bake_verify.cpp
      unit/bake_verify_surface.cpp
      golden/bake_image.cpp
    LIBS bodies_support)

  palpate_test(bake_awkward SOURCES property/bake_awkward.cpp LIBS bodies_support LABEL property)
  palpate_test(bake_awkward_long SOURCES property/bake_awkward.cpp LIBS bodies_support LABEL long)
  target_compile_definitions(bake_awkward_long PRIVATE PALPATE_LONG)

  palpate_test(bake_command_test THREADS SOURCES unit/bake_command.cpp
    LIBS palpate_rt nlohmann_json::nlohmann_json)
  add_dependencies(bake_command_test palpate)
  target_compile_definitions(bake_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
endif()
