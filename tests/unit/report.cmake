# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CLI11 REQUIRED)
  find_package(nlohmann_json REQUIRED)
  set(palpate_cli "${PROJECT_SOURCE_DIR}/tools/palpate")
  set(report_sources report_contacts report_folder report_frames report_json report_page report_shapes report_sweep report_trace
    report_view report_words words sweep_figures replay_csv replay_loop scene_engine scene_forces image_file level_mesh poses
    output_file command)
  list(TRANSFORM report_sources PREPEND "${palpate_cli}/")
  list(TRANSFORM report_sources APPEND .cpp)
  palpate_test(report_test
    SOURCES unit/report_frames.cpp unit/report_sweep.cpp unit/report_input.cpp unit/report_contacts.cpp unit/report_shapes.cpp
      unit/report_json.cpp unit/report_words.cpp ${report_sources}
    LIBS palpate_tools palpate_bake CLI11::CLI11 nlohmann_json::nlohmann_json)
  target_compile_definitions(report_test PRIVATE PALPATE_VERSION="${PROJECT_VERSION}")

  palpate_test(report_command_test SOURCES unit/report_command.cpp
    LIBS palpate_tools palpate_bake CLI11::CLI11 nlohmann_json::nlohmann_json)
  add_dependencies(report_command_test palpate)
  target_compile_definitions(report_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  if(TARGET report_bundle)
    add_dependencies(report_command_test report_bundle)
  endif()
endif()
