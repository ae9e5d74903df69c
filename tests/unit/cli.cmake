# SPDX-License-Identifier: GPL-3.0-or-later
find_package(CLI11 REQUIRED)
set(palpate_cli "${PROJECT_SOURCE_DIR}/tools/palpate")
palpate_test(cli_test
  SOURCES unit/cli_poses.cpp unit/cli_output_file.cpp unit/cli_stable_scene.cpp
    ${palpate_cli}/poses.cpp ${palpate_cli}/output_file.cpp ${palpate_cli}/stable_scene.cpp ${palpate_cli}/command.cpp
  LIBS palpate_tools palpate_bake CLI11::CLI11)

# These run the executable.
find_package(nlohmann_json REQUIRED)
palpate_test(cli_process_test SOURCES unit/cli_frame.cpp unit/cli_replay.cpp
  LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(cli_process_test palpate)
target_compile_definitions(cli_process_test PRIVATE
  PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>" PALPATE_VERSION="${PROJECT_VERSION}")
