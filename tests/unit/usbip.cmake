# SPDX-License-Identifier: Apache-2.0
palpate_test(usbip_test THREADS SOURCES unit/usbip_session.cpp unit/usbip_server.cpp unit/usbip_client.cpp unit/functionfs.cpp LIBS palpate_hal LABEL usb)

# The kernel's own client as an independent witness.
find_program(USBIP_TOOL usbip PATHS /usr/sbin)
if(PALPATE_HOST AND USBIP_TOOL)
  palpate_test(usbip_process_test SOURCES unit/usbip_process.cpp LABEL usb LIBS palpate_rt nlohmann_json::nlohmann_json)
  add_dependencies(usbip_process_test palpate-sim palpate)
  target_compile_definitions(usbip_process_test PRIVATE
    PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>" PALPATE_SIM="$<TARGET_FILE:palpate-sim>" USBIP_TOOL="${USBIP_TOOL}")
endif()
