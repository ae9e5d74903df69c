# SPDX-License-Identifier: Apache-2.0
if(PALPATE_HOST)
  palpate_test(usb_test THREADS
    SOURCES unit/usb_transport.cpp support/emulated_usbfs.cpp support/usbfs_calls.cpp
    LIBS palpate_usb LABEL usb)
  target_link_libraries(usb_test PRIVATE "${LIBUSB_LIBRARY}")

  if(NOT PALPATE_SANITIZE)  # which interpose on the same calls
    palpate_test(usb_audit_test
      SOURCES unit/usb_audit.cpp support/emulated_usbfs.cpp support/usbfs_calls.cpp
      LIBS palpate_usb palpate_tools LABEL usb)
    target_link_libraries(usb_audit_test PRIVATE "${LIBUSB_LIBRARY}" ${CMAKE_DL_LIBS})
  endif()

  # Whole programs with a simulated device, where umockdev can pretend that there is one. Preloading and sanitizers do not mix.
  find_program(UMOCKDEV_RUN umockdev-run)
  find_program(DFU_UTIL dfu-util)
  if(UMOCKDEV_RUN AND DFU_UTIL AND NOT PALPATE_SANITIZE)
    add_library(usbfs_shim MODULE support/usbfs_shim.cpp support/emulated_usbfs.cpp)
    target_link_libraries(usbfs_shim PRIVATE palpate_flags palpate_hal ${CMAKE_DL_LIBS})
    palpate_test(usb_process_test SOURCES unit/usb_process.cpp
      LIBS palpate_rt nlohmann_json::nlohmann_json LABEL usb)
    add_dependencies(usb_process_test palpate usbfs_shim)
    target_compile_definitions(usb_process_test PRIVATE
      PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>" PALPATE_SHIM="$<TARGET_FILE:usbfs_shim>"
      UMOCKDEV_RUN="${UMOCKDEV_RUN}" DFU_UTIL="${DFU_UTIL}")
    if(SODIUM_LIBRARY)
      target_compile_definitions(usb_process_test PRIVATE PALPATE_SODIUM)
    endif()
  endif()
endif()
