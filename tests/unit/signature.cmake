# SPDX-License-Identifier: Apache-2.0
# libsodium signs in these tests, and is the witness of another implementation.
find_path(SODIUM_INCLUDE sodium.h)
find_library(SODIUM_LIBRARY sodium)
if(SODIUM_INCLUDE AND SODIUM_LIBRARY)
  palpate_test(signature_test SOURCES unit/signature_ed25519.cpp LIBS palpate_hal "${SODIUM_LIBRARY}")
  target_include_directories(signature_test SYSTEM PRIVATE "${SODIUM_INCLUDE}")
endif()
