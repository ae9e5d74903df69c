# SPDX-License-Identifier: Apache-2.0
if(PALPATE_HOST)
  palpate_test(usb_test SOURCES unit/usb_transport.cpp support/emulated_usbfs.cpp LIBS palpate_usb LABEL usb)
  target_link_libraries(usb_test PRIVATE "${LIBUSB_LIBRARY}")
endif()
