# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(simplify_test SOURCES unit/simplify_levels.cpp unit/simplify_parts.cpp
    unit/simplify_refusals.cpp unit/simplify_hulls.cpp unit/simplify_awkward.cpp unit/simplify_reduce.cpp
    LIBS bodies_support)
  palpate_test(simplify_long_test SOURCES unit/simplify_awkward.cpp unit/simplify_resolutions.cpp
    LIBS bodies_support LABEL long)
  target_compile_definitions(simplify_long_test PRIVATE PALPATE_LONG)
endif()
