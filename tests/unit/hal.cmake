# SPDX-License-Identifier: Apache-2.0
palpate_test(hal_test THREADS
  SOURCES
    unit/hal_exchange.cpp unit/hal_ring.cpp unit/hal_rotation.cpp
    unit/hal_mock_path.cpp unit/hal_mock_follower.cpp unit/hal_mock_hand.cpp unit/hal_mock_device.cpp unit/hal_mock_faults.cpp
  LIBS palpate_hal)
