# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  # These run the executable.
  palpate_test(new_scene_test SOURCES unit/new_scene_command.cpp LIBS palpate_rt nlohmann_json::nlohmann_json)
  add_dependencies(new_scene_test palpate)
  target_compile_definitions(new_scene_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
endif()
