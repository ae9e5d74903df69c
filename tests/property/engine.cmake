# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CGAL REQUIRED)
  palpate_test(engine_exact SOURCES property/engine_exact.cpp LIBS palpate_bake CGAL::CGAL LABEL property)
  palpate_test(engine_budget SOURCES property/engine_budget.cpp LIBS palpate_bake CGAL::CGAL LABEL property)
  palpate_test(engine_levels SOURCES property/engine_levels.cpp LIBS palpate_bake CGAL::CGAL LABEL property)
  palpate_test(engine_refusals SOURCES fault/engine_refusals.cpp LIBS palpate_bake)
  palpate_test(engine_allocation_trap SOURCES fault/engine_allocation_trap.cpp LIBS palpate_bake palpate_tools)
endif()
