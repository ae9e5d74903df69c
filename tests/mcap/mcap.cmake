# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST AND PALPATE_PYTHON)
  add_test(NAME report.mcap COMMAND "${PALPATE_PYTHON}" "${CMAKE_CURRENT_SOURCE_DIR}/mcap/test_mcap.py")
  set_tests_properties(report.mcap PROPERTIES LABELS unit TIMEOUT 600
    ENVIRONMENT "PALPATE_EXECUTABLE=$<TARGET_FILE:palpate>;PALPATE_DATA=${PROJECT_SOURCE_DIR}/tests/data;PYTHONDONTWRITEBYTECODE=1")
endif()
