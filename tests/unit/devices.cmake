# SPDX-License-Identifier: GPL-3.0-or-later
# These run the executable.
find_package(nlohmann_json REQUIRED)
palpate_test(device_command_test SOURCES unit/device_commands.cpp
  LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(device_command_test palpate)
target_compile_definitions(device_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")

palpate_test(device_loop_test SOURCES unit/device_loop.cpp LIBS palpate_tools)
