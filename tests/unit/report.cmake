# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(report_test
    SOURCES unit/report_frames.cpp unit/report_sweep.cpp unit/report_input.cpp unit/report_contacts.cpp unit/report_shapes.cpp
      unit/report_json.cpp unit/report_words.cpp
    LIBS palpate_cli nlohmann_json::nlohmann_json)

  palpate_test(report_command_test SOURCES unit/report_command.cpp
    LIBS palpate_tools palpate_bake nlohmann_json::nlohmann_json)
  add_dependencies(report_command_test palpate)
  target_compile_definitions(report_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  if(TARGET report_bundle)
    add_dependencies(report_command_test report_bundle)
  endif()
endif()
