# SPDX-License-Identifier: Apache-2.0
# find_package(Palpate) gives Palpate::rt_core and Palpate::hal; the rest of the project is an executable, not a library.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS palpate_rt palpate_hal EXPORT PalpateTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(folder rt_core hal)
  install(DIRECTORY ${folder} DESTINATION include/palpate FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h"
    PATTERN "usb" EXCLUDE)
endforeach()
install(EXPORT PalpateTargets NAMESPACE Palpate:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Palpate)
file(WRITE "${PROJECT_BINARY_DIR}/PalpateConfig.cmake"
  "include(CMakeFindDependencyMacro)\nfind_dependency(Threads)\ninclude(\"\${CMAKE_CURRENT_LIST_DIR}/PalpateTargets.cmake\")\n")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/PalpateConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/PalpateConfig.cmake" "${PROJECT_BINARY_DIR}/PalpateConfigVersion.cmake"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Palpate)
