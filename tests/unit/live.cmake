# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(live_test THREADS SOURCES unit/live_messages.cpp unit/live_feed.cpp unit/live_server.cpp LIBS palpate_live)

  # These run the executable.
  palpate_test(live_process_test THREADS SOURCES unit/live_process.cpp LIBS palpate_live nlohmann_json::nlohmann_json)
  add_dependencies(live_process_test palpate)
  target_compile_definitions(live_process_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  if(TARGET report_bundle)
    add_dependencies(live_process_test report_bundle)
  endif()
endif()
