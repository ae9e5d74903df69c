# SPDX-License-Identifier: Apache-2.0
palpate_test(meter SOURCES unit/meter.cpp LIBS palpate_rt)
palpate_test(test_tree SOURCES unit/test_tree.cpp LIBS palpate_rt)
palpate_test(support_area SOURCES unit/support_area.cpp LIBS palpate_rt)
palpate_test(force_least_push SOURCES unit/force_least_push.cpp LIBS palpate_rt)
palpate_test(force_wrench SOURCES unit/force_wrench.cpp LIBS palpate_rt)
palpate_test(force_friction SOURCES unit/force_friction.cpp LIBS palpate_rt)
palpate_test(force_linear_contact SOURCES unit/force_linear_contact.cpp LIBS palpate_rt)
palpate_test(force_coupling SOURCES unit/force_coupling.cpp LIBS palpate_rt)

# The page's loop, compiled as C.
add_library(c_interface_loop STATIC unit/c_interface_loop.c)
set_target_properties(c_interface_loop PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_compile_options(c_interface_loop PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Werror -Wno-missing-prototypes)
target_link_libraries(c_interface_loop PRIVATE palpate_rt)
palpate_test(c_interface SOURCES unit/c_interface.cpp LIBS palpate_rt c_interface_loop)
target_compile_definitions(c_interface PRIVATE PALPATE_DOCS="${PROJECT_SOURCE_DIR}/docs" PALPATE_TESTS="${PROJECT_SOURCE_DIR}/tests")

# The engine's bits under budgets in work units; tests/gates/bits compares compilers and processors.
add_executable(engine_bits golden/engine_bits.cpp)
target_compile_options(engine_bits PRIVATE -ffp-contract=off)
target_link_libraries(engine_bits PRIVATE palpate_flags palpate_rt)
add_dependencies(short_tests engine_bits)
add_test(NAME engine.bits COMMAND engine_bits
  "${PROJECT_SOURCE_DIR}/tests/data/bumpy_ball.bin" "${PROJECT_SOURCE_DIR}/tests/data/bumpy_ball_regions.bin")
set_tests_properties(engine.bits PROPERTIES LABELS unit)
