# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(CGAL REQUIRED)
  find_package(TBB REQUIRED)
  palpate_test(metrics_deviation_test
    SOURCES unit/metrics_deviation.cpp unit/metrics_nearest.cpp
    LIBS bodies_support CGAL::CGAL TBB::tbb)
  palpate_test(metrics_support_area_test
    SOURCES unit/metrics_support_area.cpp
    LIBS bodies_support TBB::tbb)
endif()
