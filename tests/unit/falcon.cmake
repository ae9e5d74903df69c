# SPDX-License-Identifier: Apache-2.0
palpate_test(falcon_test
  SOURCES unit/falcon_kinematics.cpp unit/falcon_messages.cpp unit/falcon_device.cpp LIBS palpate_hal)
