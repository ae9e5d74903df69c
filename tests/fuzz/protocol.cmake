# SPDX-License-Identifier: Apache-2.0
if(PALPATE_FUZZ)
  # hal_fuzz(NAME SOURCES...): the code under test is compiled again, so that the fuzzer sees its branches.
  function(hal_fuzz name)
    add_executable(${name} ${ARGN})
    target_include_directories(${name} PRIVATE
      "${PROJECT_BINARY_DIR}/include_shims/hal" "${PROJECT_BINARY_DIR}/include_shims/rt_core")
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer)
    target_link_options(${name} PRIVATE -fsanitize=fuzzer)
    target_link_libraries(${name} PRIVATE palpate_flags)
    add_dependencies(fuzz_targets ${name})
    add_test(NAME ${name} COMMAND ${name}
      -max_total_time=10 -max_len=1024 -artifact_prefix=${PROJECT_BINARY_DIR}/)
    set_tests_properties(${name} PROPERTIES LABELS fuzz TIMEOUT 120)
  endfunction()

  file(GLOB protocol_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/hal/protocol/*.cpp")
  hal_fuzz(protocol_fuzz fuzz/protocol_fuzz.cpp ${protocol_sources}
    "${PROJECT_SOURCE_DIR}/hal/transport/transport.cpp")
  hal_fuzz(falcon_fuzz fuzz/falcon_fuzz.cpp "${PROJECT_SOURCE_DIR}/hal/falcon/messages.cpp"
    "${PROJECT_SOURCE_DIR}/hal/falcon/ftdi.cpp" "${PROJECT_SOURCE_DIR}/hal/falcon/kinematics.cpp")
  hal_fuzz(usbip_fuzz fuzz/usbip_fuzz.cpp "${PROJECT_SOURCE_DIR}/hal/usbip/messages.cpp"
    "${PROJECT_SOURCE_DIR}/hal/usbip/session.cpp" "${PROJECT_SOURCE_DIR}/hal/simulator/descriptors.cpp")
  target_link_libraries(usbip_fuzz PRIVATE palpate_hal)
endif()
