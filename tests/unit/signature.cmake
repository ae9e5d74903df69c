# SPDX-License-Identifier: Apache-2.0
# libsodium signs in these tests, and is the witness of another implementation.
find_path(SODIUM_INCLUDE sodium.h)
find_library(SODIUM_LIBRARY sodium)
if(SODIUM_INCLUDE AND SODIUM_LIBRARY)
  palpate_test(signature_test
    SOURCES unit/signature_ed25519.cpp unit/flash_signed.cpp unit/flash_signed_cuts.cpp
    LIBS palpate_hal "${SODIUM_LIBRARY}")
  target_compile_definitions(signature_test PRIVATE PALPATE_CUT_STRIDE=61)
  # The same at every byte.
  palpate_test(signature_cuts_test SOURCES unit/flash_signed_cuts.cpp LIBS palpate_hal "${SODIUM_LIBRARY}" LABEL long)
  target_compile_definitions(signature_cuts_test PRIVATE PALPATE_CUT_STRIDE=1)
  foreach(test signature_test signature_cuts_test)
    target_include_directories(${test} SYSTEM PRIVATE "${SODIUM_INCLUDE}")
  endforeach()
endif()
