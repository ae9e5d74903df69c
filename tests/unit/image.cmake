# SPDX-License-Identifier: Apache-2.0
palpate_test(image_test
  SOURCES unit/image_sha256.cpp unit/image_validate.cpp unit/image_format_doc.cpp LIBS palpate_rt)
target_compile_definitions(image_test PRIVATE PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs")

if(PALPATE_HOST)
  palpate_test(image_host_test SOURCES unit/image_emit.cpp unit/image_proofs_doc.cpp LIBS palpate_bake)
  target_compile_definitions(image_host_test PRIVATE PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs"
    PALPATE_CC="${CMAKE_C_COMPILER}" PALPATE_CXX="${CMAKE_CXX_COMPILER}")

  palpate_test(image_cli_test SOURCES unit/image_cli.cpp LIBS palpate_rt nlohmann_json::nlohmann_json)
  add_dependencies(image_cli_test palpate)
  target_compile_definitions(image_cli_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
endif()
