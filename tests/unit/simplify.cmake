# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  set(simplify_support unit/simplify_judge.cpp unit/simplify_random.cpp unit/decompose_shapes.cpp
    unit/decompose_oracle.cpp unit/hull_oracle.cpp)
  palpate_test(simplify_test SOURCES unit/simplify_levels.cpp unit/simplify_parts.cpp
    unit/simplify_refusals.cpp unit/simplify_hulls.cpp unit/simplify_awkward.cpp ${simplify_support}
    LIBS palpate_bake)
  palpate_test(simplify_long_test SOURCES unit/simplify_awkward.cpp unit/simplify_resolutions.cpp
    ${simplify_support} LIBS palpate_bake LABEL long)
  target_compile_definitions(simplify_long_test PRIVATE PALPATE_LONG)
endif()
