# SPDX-License-Identifier: Apache-2.0
palpate_test(usbip_test SOURCES unit/usbip_session.cpp unit/usbip_server.cpp unit/functionfs.cpp LIBS palpate_hal LABEL usb)

# The kernel's own client as an independent witness.
find_program(USBIP_TOOL usbip PATHS /usr/sbin)
if(PALPATE_HOST AND USBIP_TOOL)
  palpate_test(usbip_process_test SOURCES unit/usbip_process.cpp LABEL usb)
  add_dependencies(usbip_process_test palpate-sim)
  target_compile_definitions(usbip_process_test PRIVATE
    PALPATE_SIM="$<TARGET_FILE:palpate-sim>" USBIP_TOOL="${USBIP_TOOL}")
endif()
