# SPDX-License-Identifier: Apache-2.0
palpate_test(regions_kernels SOURCES unit/regions_kernels.cpp LIBS palpate_rt)
palpate_test(regions_border SOURCES unit/regions_border.cpp LIBS palpate_rt)
palpate_test(regions_ways_out SOURCES unit/regions_ways_out.cpp LIBS palpate_rt)
palpate_test(regions_seeds SOURCES unit/regions_seeds.cpp LIBS palpate_rt)
palpate_test(regions_crowd SOURCES unit/regions_crowd.cpp LIBS palpate_rt)
if(PALPATE_HOST)
  palpate_test(regions_image SOURCES unit/regions_image.cpp LIBS palpate_bake)
endif()
