# SPDX-License-Identifier: GPL-3.0-or-later
palpate_test(realtime_test THREADS
  SOURCES
    unit/realtime_histogram.cpp unit/realtime_safety.cpp unit/realtime_loop.cpp
    unit/realtime_wall.cpp unit/realtime_trace.cpp unit/realtime_thread.cpp
    unit/realtime_host_checks.cpp unit/realtime_usb_checks.cpp unit/realtime_passivity.cpp unit/realtime_server.cpp
    unit/realtime_steady.cpp unit/realtime_states.cpp unit/realtime_axes.cpp
    unit/safety_doc.cpp
  LIBS palpate_tools)
target_compile_definitions(realtime_test PRIVATE
  PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs" PALPATE_TESTS="${PROJECT_SOURCE_DIR}/tests")

if(NOT PALPATE_SANITIZE)  # which interpose on the same calls
  palpate_test(realtime_end_test SOURCES unit/realtime_end.cpp LIBS palpate_tools)
endif()

# These run the executable.
palpate_test(realtime_process_test THREADS SOURCES unit/realtime_process.cpp
  LIBS palpate_rt nlohmann_json::nlohmann_json)
add_dependencies(realtime_process_test palpate)
target_compile_definitions(realtime_process_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")

palpate_test(stability_map SOURCES unit/stability_map.cpp
    "${PROJECT_SOURCE_DIR}/tools/bench/pressed_wall.cpp"
  LIBS palpate_cli)
