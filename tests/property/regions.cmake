# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(regions_exact SOURCES property/regions_exact.cpp LIBS bodies_support LABEL property)
  palpate_test(regions_budget TOGETHER SOURCES property/regions_budget.cpp LIBS bodies_support palpate_tools LABEL property)
  palpate_test(regions_contained SOURCES property/regions_contained.cpp LIBS bodies_support LABEL property)
  palpate_test(regions_reserve SOURCES property/regions_reserve.cpp LIBS bodies_support LABEL property)
  palpate_test(regions_overlap SOURCES property/regions_overlap.cpp LIBS palpate_bake LABEL property)
  # The same in short and in long.
  palpate_test(regions_ways SOURCES property/regions_ways.cpp LIBS bodies_support LABEL property)
  target_compile_definitions(regions_ways PRIVATE PALPATE_WAYS=3 PALPATE_TRIANGLES=1500)
  palpate_test(regions_ways_long SOURCES property/regions_ways.cpp LIBS bodies_support LABEL long TIMEOUT 14400)
  target_compile_definitions(regions_ways_long PRIVATE PALPATE_WAYS=100 PALPATE_TRIANGLES=40000)
  palpate_test(regions_long SOURCES property/regions_long.cpp LIBS bodies_support palpate_tools LABEL long)
  palpate_test(contact_oracle SOURCES property/contact_oracle.cpp LIBS bodies_support oracle_support LABEL property)
  # Not a test: any two meshes, as many poses as one likes.
  add_executable(compare_with_oracle EXCLUDE_FROM_ALL property/compare_with_oracle.cpp "${PROJECT_SOURCE_DIR}/tools/bench/scenes.cpp")
  target_include_directories(compare_with_oracle PRIVATE "${tests_include}")
  target_link_libraries(compare_with_oracle PRIVATE palpate_flags oracle_support palpate_bake palpate_tools)
endif()
