# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: the executables, the libraries of find_package(Palpate), the shared library with the C interface and its
# pkg-config file, and what readies a host. docs/EMBEDDING.md says how to use each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Palpate)
set(share_dir ${CMAKE_INSTALL_DATADIR}/palpate)

# Who links the engine from C has no C++ driver to bring the mathematics library.
target_link_libraries(palpate_rt PUBLIC m)
set_target_properties(palpate_rt PROPERTIES EXPORT_NAME rt)
add_library(Palpate::rt ALIAS palpate_rt)

set(libraries palpate_rt palpate_hal)
get_property(can_share GLOBAL PROPERTY TARGET_SUPPORTS_SHARED_LIBS)
if(can_share)
  # The C interface for whatever loads shared libraries. It asks for the C library alone.
  set(version_script "${PROJECT_SOURCE_DIR}/cmake/libpalpate.map")
  add_library(palpate_shared SHARED $<TARGET_OBJECTS:palpate_rt>)
  target_link_libraries(palpate_shared PRIVATE $<BUILD_INTERFACE:palpate_flags> $<BUILD_INTERFACE:m>)
  target_link_options(palpate_shared PRIVATE "LINKER:--version-script=${version_script}")
  target_include_directories(palpate_shared INTERFACE "$<INSTALL_INTERFACE:include/palpate>")
  set_target_properties(palpate_shared PROPERTIES OUTPUT_NAME palpate EXPORT_NAME shared LINKER_LANGUAGE C
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINK_DEPENDS "${version_script}")
  list(APPEND libraries palpate_shared)
endif()

if(PALPATE_HOST)
  set_target_properties(palpate_usb PROPERTIES EXPORT_NAME usb)
  add_library(Palpate::usb ALIAS palpate_usb)
  list(APPEND libraries palpate_usb)
endif()
# Components are the packages of PalpatePackages.cmake.
set(dev COMPONENT development)
install(TARGETS ${libraries} EXPORT PalpateTargets ARCHIVE ${dev} LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY rt_core hal DESTINATION include/palpate ${dev} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
install(EXPORT PalpateTargets NAMESPACE Palpate:: DESTINATION ${package_dir} ${dev})

if(PALPATE_HOST)
  set_target_properties(palpate_config PROPERTIES EXPORT_NAME config)
  set_target_properties(palpate_tools PROPERTIES EXPORT_NAME realtime OUTPUT_NAME palpate_realtime)
  add_library(Palpate::realtime ALIAS palpate_tools)
  install(TARGETS palpate_config palpate_tools EXPORT PalpateHostTargets ARCHIVE ${dev})
  install(DIRECTORY config DESTINATION include/palpate ${dev} FILES_MATCHING PATTERN "*.hpp")
  install(DIRECTORY tools/realtime DESTINATION include/palpate/tools ${dev} FILES_MATCHING PATTERN "*.hpp")
  install(EXPORT PalpateHostTargets NAMESPACE Palpate:: DESTINATION ${package_dir} ${dev})
  install(TARGETS palpate palpate-sim RUNTIME COMPONENT tools)
  # As in the sources, so that tools/setup/host finds what it installs.
  install(PROGRAMS tools/setup/host DESTINATION ${share_dir}/tools/setup COMPONENT tools)
  install(PROGRAMS tools/gadget DESTINATION ${share_dir}/tools COMPONENT tools)
  install(DIRECTORY config/udev config/host config/scenes DESTINATION ${share_dir}/config COMPONENT tools)
endif()

configure_package_config_file(cmake/PalpateConfig.cmake.in "${PROJECT_BINARY_DIR}/PalpateConfig.cmake"
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/PalpateConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/PalpateConfig.cmake" "${PROJECT_BINARY_DIR}/PalpateConfigVersion.cmake"
  DESTINATION ${package_dir} ${dev})
file(RELATIVE_PATH up_to_prefix "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" /prefix)
configure_file(cmake/palpate.pc.in "${PROJECT_BINARY_DIR}/palpate.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/palpate.pc" DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${dev})
