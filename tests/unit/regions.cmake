# SPDX-License-Identifier: Apache-2.0
palpate_test(regions_kernels SOURCES unit/regions_kernels.cpp LIBS palpate_rt)
palpate_test(regions_near_pairs SOURCES unit/regions_near_pairs.cpp LIBS palpate_rt)
palpate_test(regions_explained SOURCES unit/regions_explained.cpp LIBS palpate_rt)
if(PALPATE_HOST)
  palpate_test(regions_image SOURCES unit/regions_image.cpp LIBS bodies_support)
  palpate_test(regions_boxes SOURCES unit/regions_boxes.cpp LIBS palpate_bake)
endif()
