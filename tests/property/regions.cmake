# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CGAL REQUIRED)
  palpate_test(regions_exact SOURCES property/regions_exact.cpp LIBS palpate_bake CGAL::CGAL LABEL property)
  palpate_test(regions_budget SOURCES property/regions_budget.cpp LIBS palpate_bake palpate_tools CGAL::CGAL LABEL property)
endif()
