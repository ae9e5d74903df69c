# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CGAL REQUIRED)
  palpate_test(regions_exact SOURCES property/regions_exact.cpp LIBS palpate_bake CGAL::CGAL LABEL property)
  palpate_test(regions_budget SOURCES property/regions_budget.cpp LIBS palpate_bake palpate_tools CGAL::CGAL LABEL property)
  palpate_test(regions_contained SOURCES property/regions_contained.cpp LIBS palpate_bake LABEL property)
  palpate_test(regions_overlap SOURCES property/regions_overlap.cpp LIBS palpate_bake LABEL property)
  palpate_test(regions_long SOURCES property/regions_long.cpp LIBS palpate_bake palpate_tools CGAL::CGAL LABEL long)
endif()
