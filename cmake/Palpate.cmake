# SPDX-License-Identifier: Apache-2.0
# What every target shares: the language level, the warnings, the sanitizers, and the include shims that make the dependency
# table of docs/DESIGN.md true.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(PALPATE_CCACHE ccache)
if(PALPATE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers are cached only by those who say that they know of them.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${PALPATE_CCACHE}")
endif()

set(PALPATE_SANITIZE "" CACHE STRING "Sanitizers for every target, as -fsanitize takes them (address,undefined or thread)")
option(PALPATE_COVERAGE "Instrument for gcov" OFF)
option(PALPATE_UNITY "Compile what belongs together as one: headers are read once" OFF)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12's superword vectoriser turns the round trip double -> float -> double of two neighbours into nothing: what is
  # rounded to float would then be computed with unrounded.
  add_compile_options(-fno-tree-slp-vectorize)
  if(PALPATE_CCACHE)
    add_compile_options(-fpch-preprocess)
  endif()
endif()

add_library(palpate_flags INTERFACE)
target_compile_options(palpate_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast -Wcast-align
  -Wundef -Wformat=2 -Wvla -Wmissing-declarations $<$<NOT:$<CONFIG:Release>>:-Werror>)
if(NOT PALPATE_UNITY OR CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # Clang also counts what files of a folder have of one name
  target_compile_options(palpate_flags INTERFACE -Wshadow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 sees these in std::string and in CGAL's inlined code, where there is none.
  target_compile_options(palpate_flags INTERFACE -Wno-maybe-uninitialized -Wno-restrict $<$<CONFIG:Release>:-Wno-stringop-overflow;-Wno-array-bounds>)
endif()
if(PALPATE_SANITIZE)
  target_compile_options(palpate_flags INTERFACE -fsanitize=${PALPATE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(palpate_flags INTERFACE -fsanitize=${PALPATE_SANITIZE})
  target_compile_definitions(palpate_flags INTERFACE PALPATE_SANITIZED)
  if(PALPATE_SANITIZE STREQUAL "thread")
    # GCC and Clang have no common name for it.
    target_compile_definitions(palpate_flags INTERFACE PALPATE_THREAD_SANITIZER)
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(palpate_flags INTERFACE "-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/tests/sanitizers/ignored")
  endif()
endif()
if(PALPATE_COVERAGE)
  target_compile_options(palpate_flags INTERFACE --coverage)
  target_link_options(palpate_flags INTERFACE --coverage)
endif()

# Same bits on every target: no contraction into fused multiply-add.
set(PALPATE_RT_FLAGS -fno-exceptions -fno-rtti -ffp-contract=off -fstack-usage)
if(NOT PALPATE_SANITIZE AND NOT PALPATE_COVERAGE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  list(APPEND PALPATE_RT_FLAGS -Wframe-larger-than=2048)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND PALPATE_RT_FLAGS -fcallgraph-info=su)
endif()

# palpate_shim(FOLDER OUT): an include path that holds nothing but `FOLDER/`.
function(palpate_shim folder out)
  set(shim "${PROJECT_BINARY_DIR}/include_shims/${folder}")
  file(MAKE_DIRECTORY "${shim}")
  if(NOT EXISTS "${shim}/${folder}")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${folder}" "${shim}/${folder}" SYMBOLIC)
  endif()
  set(${out} "${shim}" PARENT_SCOPE)
endfunction()

# palpate_unity(TARGET): where PALPATE_UNITY is on, the sources of each folder are compiled as one. So what a file keeps to itself
# has a name of its own within its folder.
function(palpate_unity target)
  if(NOT PALPATE_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME group)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# palpate_module(TARGET FOLDER SOURCES...): a static library whose public include path holds nothing but `FOLDER/`, so that a
# target sees only the folders it links.
function(palpate_module target folder)
  palpate_shim(${folder} shim)
  add_library(${target} STATIC ${ARGN})
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${shim}>" "$<INSTALL_INTERFACE:include/palpate>")
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:palpate_flags>)
endfunction()
