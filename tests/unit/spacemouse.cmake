# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  # One of these runs the executable.
  palpate_test(spacemouse_test THREADS SOURCES unit/spacemouse.cpp LIBS palpate_spacemouse palpate_rt nlohmann_json::nlohmann_json)
  add_dependencies(spacemouse_test palpate)
  target_compile_definitions(spacemouse_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
  if(SPNAV_INCLUDE AND SPNAV_LIBRARY)
    target_compile_definitions(spacemouse_test PRIVATE PALPATE_SPNAV)
  endif()
endif()
