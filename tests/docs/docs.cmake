# SPDX-License-Identifier: GPL-3.0-or-later
# The commands of pages, as they are written there.
if(PALPATE_HOST AND PALPATE_PYTHON AND NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT PALPATE_FUZZ)
  set(run_page "${PALPATE_PYTHON}" "${CMAKE_CURRENT_SOURCE_DIR}/docs/run_page.py" "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
  set(docs_quick README.md examples/README.md docs/PYTHON.md docs/REPORT.md)
  # These bake the largest models, or sweep.
  set(docs_long config/README.md docs/LEVELS.md docs/SWEEP.md docs/TUTORIAL.md)
  foreach(page IN LISTS docs_quick docs_long)
    add_test(NAME "docs.${page}" COMMAND ${run_page} "${page}")
    set_tests_properties("docs.${page}" PROPERTIES LABELS unit TIMEOUT 600)
  endforeach()
  foreach(page IN LISTS docs_long)
    set_tests_properties("docs.${page}" PROPERTIES LABELS long)
  endforeach()
  # Both install.
  set_tests_properties(docs.examples/README.md PROPERTIES RESOURCE_LOCK install)
  add_test(NAME docs.commands COMMAND ${run_page} --check ${docs_quick} ${docs_long})
  set_tests_properties(docs.commands PROPERTIES LABELS unit)
endif()
