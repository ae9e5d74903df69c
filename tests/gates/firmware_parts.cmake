# SPDX-License-Identifier: Apache-2.0
# The device's half of hal must compile for a microcontroller.
find_program(ARM_NONE_EABI_GXX arm-none-eabi-g++)
if(ARM_NONE_EABI_GXX AND NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT PALPATE_FUZZ)
  add_test(NAME hal.firmware_parts
    COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/gates/firmware_parts" "${PROJECT_BINARY_DIR}/firmware_parts")
  set_tests_properties(hal.firmware_parts PROPERTIES LABELS firmware)
endif()
