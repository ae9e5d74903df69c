# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CGAL REQUIRED)
  palpate_test(force_analytic SOURCES property/force_analytic.cpp LIBS palpate_bake LABEL property)
  palpate_test(force_hostile_motion SOURCES property/force_hostile_motion.cpp LIBS palpate_bake palpate_tools CGAL::CGAL LABEL property)
endif()
