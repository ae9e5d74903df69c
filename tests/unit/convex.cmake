# SPDX-License-Identifier: Apache-2.0
foreach(part random penetration)
  palpate_test(test_convex_${part}
    SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_${part}.cpp" "${CMAKE_CURRENT_LIST_DIR}/convex_shapes.cpp"
    LIBS palpate_rt)
endforeach()
