# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(regions_exact SOURCES property/regions_exact.cpp LIBS bodies_support LABEL property)
  palpate_test(regions_budget TOGETHER SOURCES property/regions_budget.cpp LIBS bodies_support palpate_tools LABEL property)
  palpate_test(regions_follow TOGETHER SOURCES property/regions_follow.cpp LIBS palpate_bake LABEL property)
  palpate_test(regions_contained SOURCES property/regions_contained.cpp LIBS bodies_support LABEL property)
  palpate_test(regions_overlap SOURCES property/regions_overlap.cpp LIBS palpate_bake LABEL property)
  palpate_test(regions_long SOURCES property/regions_long.cpp LIBS bodies_support palpate_tools LABEL long)
endif()
