# SPDX-License-Identifier: GPL-3.0-or-later
# These run the executable.
palpate_test(device_command_test THREADS SOURCES unit/device_commands.cpp
  LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(device_command_test palpate)
target_compile_definitions(device_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")

palpate_test(device_loop_test THREADS SOURCES unit/device_loop.cpp LIBS palpate_tools)

if(SODIUM_LIBRARY)
  find_program(OPENSSL openssl)
  palpate_test(key_command_test SOURCES unit/key_command.cpp LIBS palpate_rt)
  add_dependencies(key_command_test palpate)
  target_compile_definitions(key_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  if(OPENSSL)
    target_compile_definitions(key_command_test PRIVATE OPENSSL="${OPENSSL}")
  endif()
endif()
