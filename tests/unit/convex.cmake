# SPDX-License-Identifier: Apache-2.0
set(convex_shapes "${CMAKE_CURRENT_LIST_DIR}/convex_shapes.cpp")
palpate_test(test_convex_random SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_random.cpp" ${convex_shapes} LIBS palpate_rt)
