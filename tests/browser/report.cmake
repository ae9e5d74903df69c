# SPDX-License-Identifier: GPL-3.0-or-later
if(TARGET report_bundle)
  add_test(NAME report_units COMMAND "${PALPATE_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/units.mjs")
  add_test(NAME live_units COMMAND "${PALPATE_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/live_units.mjs")
  set_tests_properties(report_units live_units PROPERTIES LABELS unit)
endif()

# Not in the regular suite: Chromium takes two minutes to install on a bare machine.
find_program(PALPATE_CHROMIUM NAMES chromium chromium-browser google-chrome DOC "Shows reports to their test")
if(TARGET report_bundle AND PALPATE_CHROMIUM)
  add_test(NAME report_browser
    COMMAND "${PALPATE_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/report.mjs" "${PALPATE_CHROMIUM}" "$<TARGET_FILE:palpate>"
      "${PROJECT_SOURCE_DIR}/tests/data/sweep.json")
  set_tests_properties(report_browser PROPERTIES LABELS "long;browser" TIMEOUT 600)
endif()

if(TARGET report_bundle AND PALPATE_CHROMIUM)
  add_test(NAME live_browser
    COMMAND "${PALPATE_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/live.mjs" "${PALPATE_CHROMIUM}" "$<TARGET_FILE:palpate>")
  set_tests_properties(live_browser PROPERTIES LABELS "long;browser" TIMEOUT 600)
endif()

# The parts of the README, in millimetres.
if(TARGET report_bundle AND PALPATE_CHROMIUM AND PALPATE_PYTHON)
  add_test(NAME try_browser.meshes COMMAND "${PALPATE_PYTHON}" "${PROJECT_SOURCE_DIR}/examples/two_parts.py"
    WORKING_DIRECTORY "${PROJECT_BINARY_DIR}")
  add_test(NAME try_browser
    COMMAND "${PALPATE_NODE}" "${PROJECT_SOURCE_DIR}/tests/browser/try.mjs" "${PALPATE_CHROMIUM}" "$<TARGET_FILE:palpate>"
      "${PROJECT_BINARY_DIR}/pin.stl" "${PROJECT_BINARY_DIR}/plate.stl")
  set_tests_properties(try_browser.meshes PROPERTIES LABELS "long;browser" FIXTURES_SETUP two_parts)
  set_tests_properties(try_browser PROPERTIES LABELS "long;browser" TIMEOUT 600 FIXTURES_REQUIRED two_parts)
endif()
