# SPDX-License-Identifier: Apache-2.0
# The Python module, as it lies in the build.
if(TARGET palpate_python)
  set(python_environment "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1"
    "PALPATE_DATA=${PROJECT_SOURCE_DIR}/tests/data;PALPATE_DOCS=${PROJECT_SOURCE_DIR}/docs;PALPATE_EXECUTABLE=$<TARGET_FILE:palpate>")
  foreach(name IN ITEMS engine files)
    add_test(NAME python.${name}
      COMMAND "${PALPATE_PYTHON}" -W error "${CMAKE_CURRENT_SOURCE_DIR}/python/test_${name}.py")
    set_tests_properties(python.${name} PROPERTIES LABELS unit TIMEOUT 600 ENVIRONMENT "${python_environment}")
  endforeach()
endif()
