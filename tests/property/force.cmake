# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  palpate_test(force_analytic SOURCES property/force_analytic.cpp LIBS palpate_bake LABEL property)
  palpate_test(force_hostile_motion SOURCES property/force_hostile_motion.cpp LIBS bodies_support palpate_tools LABEL property)
  palpate_test(force_continuity TOGETHER SOURCES property/force_continuity.cpp LIBS palpate_bake palpate_tools LABEL property)
  palpate_test(force_rolled TOGETHER SOURCES property/force_rolled.cpp "${PROJECT_SOURCE_DIR}/tools/bench/scenes.cpp"
    LIBS palpate_bake palpate_tools LABEL property)
  # The same in short and in long.
  palpate_test(force_energy SOURCES property/force_energy.cpp LIBS palpate_bake palpate_tools LABEL property)
  target_compile_definitions(force_energy PRIVATE PALPATE_TICKS=20000)
  palpate_test(force_energy_long SOURCES property/force_energy.cpp LIBS palpate_bake palpate_tools LABEL long)
  target_compile_definitions(force_energy_long PRIVATE PALPATE_TICKS=1000000)
endif()
