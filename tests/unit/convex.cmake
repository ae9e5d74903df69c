# SPDX-License-Identifier: Apache-2.0
palpate_test_support(convex_support SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_shapes.cpp" LIBS palpate_rt)
foreach(part degenerate penetration pressure random triangles)
  palpate_test(test_convex_${part}
    SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_${part}.cpp" LIBS convex_support)
endforeach()
# The golden bits must not depend on what the compiler contracts.
target_compile_options(convex_support PRIVATE -ffp-contract=off)
target_compile_options(test_convex_degenerate PRIVATE -ffp-contract=off)

palpate_test(test_convex_random_long LABEL long
  SOURCES "${CMAKE_CURRENT_LIST_DIR}/convex_random.cpp" LIBS convex_support)
target_compile_definitions(test_convex_random_long PRIVATE PALPATE_CONVEX_QUERIES=10000000)
