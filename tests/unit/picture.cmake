# SPDX-License-Identifier: GPL-3.0-or-later
if(PALPATE_HOST)
  find_package(PNG REQUIRED)
  palpate_test(picture_test
    SOURCES unit/picture_raster.cpp unit/picture_view.cpp unit/picture_text.cpp unit/picture_png.cpp
    LIBS palpate_picture PNG::PNG)

  palpate_test(picture_levels_test SOURCES unit/picture_levels.cpp LIBS palpate_cli)

  palpate_test(picture_command_test SOURCES unit/picture_command.cpp LIBS palpate_rt)
  add_dependencies(picture_command_test palpate)
  target_compile_definitions(picture_command_test PRIVATE PALPATE_EXECUTABLE="$<TARGET_FILE:palpate>")
endif()
