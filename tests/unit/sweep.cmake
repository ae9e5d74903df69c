# SPDX-License-Identifier: GPL-3.0-or-later
palpate_test(sweep_test
  SOURCES unit/sweep_figures.cpp unit/sweep_settings.cpp unit/sweep_motions.cpp unit/sweep_plot.cpp
  LIBS palpate_cli)

# These run the executable.
palpate_test(sweep_process_test SOURCES unit/sweep_command.cpp LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(sweep_process_test palpate)
target_compile_definitions(sweep_process_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")

palpate_test(motion_process_test SOURCES unit/motion_command.cpp LIBS palpate_rt)
add_dependencies(motion_process_test palpate)
target_compile_definitions(motion_process_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
