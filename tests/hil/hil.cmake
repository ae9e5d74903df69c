# SPDX-License-Identifier: Apache-2.0
# The stack on a PREEMPT_RT kernel in QEMU: ctest -L hil. Skipped, with the reason, where QEMU or a kernel cannot be had.
if(PALPATE_HOST AND NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT PALPATE_FUZZ)
  add_test(NAME hil COMMAND "${PROJECT_SOURCE_DIR}/tools/hil" --programs $<TARGET_FILE_DIR:palpate>)
  set_tests_properties(hil PROPERTIES LABELS hil TIMEOUT 1800 SKIP_RETURN_CODE 77)
endif()

find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME hil.judge COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/hil/judge_test.py")
  set_tests_properties(hil.judge PROPERTIES LABELS unit)
endif()
