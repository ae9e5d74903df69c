# SPDX-License-Identifier: Apache-2.0
palpate_test(protocol_test SOURCES unit/protocol_packets.cpp unit/protocol_ends.cpp unit/protocol_obedience.cpp unit/protocol_joints.cpp LIBS palpate_hal)
target_compile_definitions(protocol_test PRIVATE PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs")
