# SPDX-License-Identifier: Apache-2.0
if(PALPATE_FUZZ)
  # The code under test is compiled again, so that the fuzzer sees its branches.
  file(GLOB image_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/rt_core/image/*.cpp")
  add_executable(validate_fuzz fuzz/validate_fuzz.cpp ${image_sources}
    "${PROJECT_SOURCE_DIR}/rt_core/base/status.cpp")
  target_include_directories(validate_fuzz PRIVATE "${PROJECT_BINARY_DIR}/include_shims/rt_core")
  target_compile_options(validate_fuzz PRIVATE -fsanitize=fuzzer)
  target_link_options(validate_fuzz PRIVATE -fsanitize=fuzzer)
  target_link_libraries(validate_fuzz PRIVATE palpate_flags)
  add_custom_target(fuzz_targets DEPENDS validate_fuzz)
  add_test(NAME validate_fuzz COMMAND validate_fuzz
    -max_total_time=10 -max_len=16384 -artifact_prefix=${PROJECT_BINARY_DIR}/)
  set_tests_properties(validate_fuzz PROPERTIES LABELS fuzz TIMEOUT 120)
endif()
