# SPDX-License-Identifier: Apache-2.0
palpate_test(flash_test SOURCES unit/flash_slots.cpp unit/flash_update.cpp unit/flash_file.cpp unit/flash_times.cpp LIBS palpate_hal)
