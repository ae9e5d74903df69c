# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_FUZZ AND PALPATE_HOST)
  # The code under test is compiled again, so that the fuzzer sees its branches.
  add_executable(live_fuzz fuzz/live_fuzz.cpp "${PROJECT_SOURCE_DIR}/tools/live/messages.cpp")
  target_compile_options(live_fuzz PRIVATE -fsanitize=fuzzer)
  target_link_options(live_fuzz PRIVATE -fsanitize=fuzzer)
  target_link_libraries(live_fuzz PRIVATE palpate_flags palpate_tools)
  add_dependencies(fuzz_targets live_fuzz)
  add_test(NAME live_fuzz COMMAND live_fuzz
    -max_total_time=10 -max_len=128 -artifact_prefix=${PROJECT_BINARY_DIR}/)
  set_tests_properties(live_fuzz PROPERTIES LABELS fuzz TIMEOUT 120)
endif()
