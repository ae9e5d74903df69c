# SPDX-License-Identifier: Apache-2.0
# Promises of rt_core that are read from its objects: nothing asked for from outside, no recursion, a bounded stack. Optimised
# builds without instrumentation only.
set(PALPATE_STACK_LIMIT 8192)
if(NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE)
  add_test(NAME rt_core.symbols
    COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/symbols" ${CMAKE_NM} $<TARGET_FILE:palpate_rt>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_test(NAME rt_core.stack
      COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/stack.py" "${PROJECT_BINARY_DIR}" ${PALPATE_STACK_LIMIT}
        palpate::tick palpate::create palpate::validate
        test_boxes triangle_distances triangle_ways triangle_courses separations witnesses point_boxes)
  endif()
endif()

# The engine's bits from every compiler and processor at hand: rt_core is built ten times.
if(NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE)
  add_test(NAME engine.bits_everywhere COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/bits")
  set_tests_properties(engine.bits_everywhere PROPERTIES LABELS long TIMEOUT 3600)
endif()

# An installed copy, as firmware, hosts in C and C++, and people use it.
if(PALPATE_HOST AND NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT PALPATE_FUZZ)
  add_test(NAME install.find_package
    COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/install" "${CMAKE_COMMAND}" "${PROJECT_BINARY_DIR}" "${CMAKE_NM}")
  set_tests_properties(install.find_package PROPERTIES RESOURCE_LOCK install)
endif()
# Debian packages of it, where Debian's tools are.
find_program(PALPATE_SHLIBDEPS dpkg-shlibdeps)
if(PALPATE_SHLIBDEPS AND PALPATE_HOST AND NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT PALPATE_FUZZ)
  add_test(NAME install.packages
    COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/packages" "${CMAKE_COMMAND}" "${PROJECT_BINARY_DIR}" "${PALPATE_PYTHON}")
  set_tests_properties(install.packages PROPERTIES LABELS long RESOURCE_LOCK install FIXTURES_SETUP packages)
  add_test(NAME install.bare_debian COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/bare_debian" "${PROJECT_BINARY_DIR}")
  set_tests_properties(install.bare_debian PROPERTIES LABELS long FIXTURES_REQUIRED packages SKIP_RETURN_CODE 77 TIMEOUT 1800)
endif()
get_property(gates DIRECTORY PROPERTY TESTS)
foreach(gate rt_core.symbols rt_core.stack install.find_package)
  if(gate IN_LIST gates)
    set_tests_properties(${gate} PROPERTIES LABELS unit)
  endif()
endforeach()
