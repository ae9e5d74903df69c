# SPDX-License-Identifier: Apache-2.0
palpate_test(image_test
  SOURCES unit/image_sha256.cpp unit/image_validate.cpp unit/image_format_doc.cpp LIBS palpate_rt)
target_compile_definitions(image_test PRIVATE PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs")

if(PALPATE_HOST)
  palpate_test(image_emit_test SOURCES unit/image_emit.cpp LIBS palpate_bake)
  target_compile_definitions(image_emit_test PRIVATE
    PALPATE_CC="${CMAKE_C_COMPILER}" PALPATE_CXX="${CMAKE_CXX_COMPILER}")
endif()
