# SPDX-License-Identifier: Apache-2.0
palpate_test(hal_test
  SOURCES
    unit/hal_exchange_test.cpp unit/hal_ring_test.cpp unit/hal_rotation_test.cpp
    unit/hal_mock_path_test.cpp unit/hal_mock_hand_test.cpp unit/hal_mock_device_test.cpp
  LIBS palpate_hal)
