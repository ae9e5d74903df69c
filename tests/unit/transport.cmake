# SPDX-License-Identifier: Apache-2.0
palpate_test(transport_test THREADS SOURCES unit/streamed_device.cpp LIBS palpate_hal)
