# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(simplify_test SOURCES unit/simplify_levels.cpp unit/simplify_parts.cpp
    unit/simplify_judge.cpp unit/decompose_shapes.cpp unit/decompose_oracle.cpp
    LIBS palpate_bake)
endif()
