# SPDX-License-Identifier: GPL-3.0-or-later
palpate_test(cli_test SOURCES unit/cli_clocks.cpp unit/cli_fault_words.cpp unit/cli_output_file.cpp unit/cli_poses.cpp unit/cli_stable_scene.cpp
  unit/cli_surface_points.cpp LIBS palpate_cli)

# These run the executable.
palpate_test(cli_process_test SOURCES unit/cli_frame.cpp unit/cli_replay.cpp
  LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(cli_process_test palpate)
target_compile_definitions(cli_process_test PRIVATE
  PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>" PALPATE_VERSION="${PROJECT_VERSION}")
