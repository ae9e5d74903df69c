# SPDX-License-Identifier: Apache-2.0
# `cpack -G DEB` in a build folder: the Debian packages palpate, libpalpate0, libpalpate-dev and, where its module is built,
# python3-palpate. They go below /usr.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "Palpate's developers <palpate@localhost>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Its own libraries are not in any package that dpkg-shlibdeps could find.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}")

set(CPACK_COMPONENTS_ALL tools library development)
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME palpate)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
  "Commands: bakes meshes into images, runs the real-time loop against a haptic device, replays, sweeps and reports.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libpalpate0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Shared library: the contact engine by its C interface.")
# ldconfig has to hear of it.
file(WRITE "${PROJECT_BINARY_DIR}/packages/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/packages/triggers")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpalpate-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libpalpate0 (= ${PROJECT_VERSION}), libusb-1.0-0-dev, libtomlplusplus-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Development files: headers, static libraries, CMake targets and the pkg-config file.")

if(TARGET palpate_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-palpate)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  list(GET PALPATE_PYTHON_VERSION 0 major)
  list(GET PALPATE_PYTHON_VERSION 1 minor)
  math(EXPR next "${minor} + 1")
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "libpalpate0 (= ${PROJECT_VERSION}), python3-numpy, "
    "python3 (>= ${major}.${minor}), python3 (<< ${major}.${next})")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module: the contact engine, scenes, motions and traces with NumPy arrays.")
endif()

# Where Debian looks for licences.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES LICENSE.md DESTINATION share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME} RENAME copyright COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
