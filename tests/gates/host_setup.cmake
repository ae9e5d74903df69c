# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  add_test(NAME tools.host_setup
    COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/host_setup" "${PROJECT_BINARY_DIR}/host_setup")
  set_tests_properties(tools.host_setup PROPERTIES LABELS unit)
endif()
