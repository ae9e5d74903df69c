# SPDX-License-Identifier: Apache-2.0
foreach(part degenerate penetration random triangles)
  palpate_test(test_convex_${part}
    SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_${part}.cpp" "${CMAKE_CURRENT_LIST_DIR}/convex_shapes.cpp"
    LIBS palpate_rt)
endforeach()
# The golden bits must not depend on what the compiler contracts.
target_compile_options(test_convex_degenerate PRIVATE -ffp-contract=off)

palpate_test(test_convex_random_long LABEL long
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_random.cpp" "${CMAKE_CURRENT_LIST_DIR}/convex_shapes.cpp"
  LIBS palpate_rt)
target_compile_definitions(test_convex_random_long PRIVATE PALPATE_CONVEX_QUERIES=10000000)
