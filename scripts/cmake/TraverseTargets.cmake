# How every target of the project is built: one place for the language level, the warnings, the
# sanitizers and the naming of targets.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(TRAVERSE_CCACHE ccache)
if(TRAVERSE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache wants to be told before it stores what was compiled with precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${TRAVERSE_CCACHE})
endif()

# Sources that are compiled together, six at a time, take half of the processor's time: those of the
# tests are, but for the debug build, and those of the libraries where CMAKE_UNITY_BUILD says so, in
# all builds but "check" and "debug". There each source must include what it uses.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 6)

# No AVX flags here: MRPT and Ceres of Debian are built for plain x86-64, and Eigen's heap alignment
# differs with AVX, which corrupts memory across the library boundary.
add_library(traverse_build_flags INTERFACE)
target_compile_options(traverse_build_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Werror
  # GCC 12 sees overlaps and sizes in std::string's functions (PR 105651, 105329) and, through Eigen's
  # expression templates, uninitialised values that are not there; all only in optimised builds.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-stringop-overflow -Wno-maybe-uninitialized>
  # In a source that includes others GCC takes what is internal to them for a header's.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage -Wno-array-bounds>
  # Clang refuses what touches a member without the mutex that guards it (parallel/mutex.hpp).
  $<$<CXX_COMPILER_ID:Clang>:-Wthread-safety>)
if(TRAVERSE_SANITIZE)
  target_compile_options(traverse_build_flags INTERFACE
    -fsanitize=${TRAVERSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(TRAVERSE_SANITIZE MATCHES "address,undefined")
    # Left out are the checks after whose errors the address sanitizer stops too.
    target_compile_options(traverse_build_flags INTERFACE -fno-sanitize=null,object-size)
  endif()
  # Under a sanitizer Eigen aligns heap memory by hand, which Debian's Ceres and MRPT would then free
  # wrongly; the sanitizers' malloc is aligned to 16 bytes like glibc's.
  target_compile_definitions(traverse_build_flags INTERFACE
    EIGEN_MALLOC_ALREADY_ALIGNED=1 TRAVERSE_SANITIZED)  # compilers' own macros differ
  target_link_options(traverse_build_flags INTERFACE -fsanitize=${TRAVERSE_SANITIZE})
endif()

# What is tested is optimised and instrumented in full. The tests' own sources need neither: they
# compile in two thirds of the time without.
add_library(traverse_test_flags INTERFACE)
target_compile_options(traverse_test_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:-O1>)
if(TRAVERSE_SANITIZE MATCHES undefined)
  target_compile_options(traverse_test_flags INTERFACE -fno-sanitize=undefined)
endif()

# Headers that nearly every source includes are precompiled: for the tests always, for libraries in
# the same builds.
option(TRAVERSE_PRECOMPILE "Precompile headers for the libraries too" OFF)
set(TRAVERSE_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span>
  <string> <string_view> <utility> <vector> <Eigen/Dense> <fmt/format.h>)

# traverse_precompile(TARGET HOLDER [HEADERS header...] [FLAGS target...])
#
# Lets TARGET use the precompiled headers of HOLDER, a target of nothing else, which is made when it
# is first asked for, with further HEADERS and what FLAGS tell: libraries, programs and tests are
# compiled in different ways.
function(traverse_precompile target holder)
  cmake_parse_arguments(ARG "" "" "HEADERS;FLAGS" ${ARGN})
  if(NOT TARGET ${holder})
    file(WRITE ${CMAKE_BINARY_DIR}/${holder}.cpp "int main() {}\n")
    get_target_property(kind ${target} TYPE)
    if(kind STREQUAL EXECUTABLE)
      add_executable(${holder} ${CMAKE_BINARY_DIR}/${holder}.cpp)
    else()
      add_library(${holder} STATIC ${CMAKE_BINARY_DIR}/${holder}.cpp)
    endif()
    target_link_libraries(${holder} PRIVATE Eigen3::Eigen fmt::fmt ${ARG_FLAGS})
    target_precompile_headers(${holder} PRIVATE ${TRAVERSE_COMMON_HEADERS} ${ARG_HEADERS})
  endif()
  foreach(library IN LISTS ARG_FLAGS ITEMS Eigen3::Eigen fmt::fmt)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${library}>)
  endforeach()
  target_precompile_headers(${target} REUSE_FROM ${holder})
endfunction()

# traverse_library(NAME SOURCES ... [USES ...] [PRIVATELY_USES ...])
#
# Defines traverse::NAME from libs/NAME; installed with its public headers it is Traverse::NAME. USES
# are the libraries that its public headers show, PRIVATELY_USES those that stay behind its sources.
function(traverse_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PRIVATELY_USES" ${ARGN})
  add_library(traverse_${name} STATIC ${ARG_SOURCES})
  add_library(traverse::${name} ALIAS traverse_${name})
  target_include_directories(traverse_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(traverse_${name} PUBLIC cxx_std_20)
  target_link_libraries(traverse_${name} PUBLIC ${ARG_USES})
  foreach(library IN LISTS ARG_PRIVATELY_USES ITEMS traverse_build_flags)
    if(library IN_LIST TRAVERSE_HEADERS_ONLY OR library STREQUAL traverse_build_flags)
      set(library $<BUILD_INTERFACE:${library}>)  # an installed library asks for none of these
    endif()
    target_link_libraries(traverse_${name} PRIVATE ${library})
  endforeach()
  set_target_properties(traverse_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS traverse_${name} EXPORT TraverseTargets COMPONENT development
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  if(TRAVERSE_PRECOMPILE)
    traverse_precompile(traverse_${name} precompiled_for_libraries HEADERS <nlohmann/json.hpp>
      FLAGS nlohmann_json::nlohmann_json traverse_build_flags)
  endif()
endfunction()

# What `scripts/test --unit` builds, and what the sanitizers' builds do.
add_custom_target(unit_tests)
add_custom_target(sanitized_tests)

# traverse_test(NAME SOURCES ... USES ... [LABEL label] [SHARDS n] [TIMEOUT seconds] [LONG]
#               [LONG_SANITIZED SUITE.CASE...])
#
# Defines the GoogleTest program NAME_test and registers it with CTest under LABEL (unit where none is
# given; end-to-end, window, slurm; tests/browser has its own): once, or as n shards that run side by
# side. LONG: it has suites whose names begin with Long, which are a test of their own with the label
# long and run under `scripts/test --long` only. LONG_SANITIZED: these (patterns as --gtest_filter
# takes them) give the same code other figures, and under a sanitizer, ten times as slow, they are
# long too. Cases share a process, because loading the libraries
# and setting up a suite take longer than most of them; `NAME_test --gtest_filter=SUITE.CASE` runs one.
function(traverse_test name)
  cmake_parse_arguments(ARG "LONG" "LABEL;SHARDS;TIMEOUT" "SOURCES;USES;LONG_SANITIZED" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  set(long "")
  if(ARG_LONG)
    list(APPEND long Long*)
  endif()
  if(TRAVERSE_SANITIZE)
    list(APPEND long ${ARG_LONG_SANITIZED})
  endif()
  set(filter "")
  if(long)
    list(JOIN long : long)
    set(filter --gtest_filter=-${long})
    add_test(NAME ${name}.long COMMAND ${name}_test --gtest_filter=${long})
    set_tests_properties(${name}.long PROPERTIES TIMEOUT 3600 LABELS long)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 1200)
  endif()
  add_executable(${name}_test ${ARG_SOURCES})
  target_include_directories(${name}_test PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/libs/${name}/src)
    # What a library keeps to itself its own tests see, and no others.
    target_include_directories(${name}_test PRIVATE ${CMAKE_SOURCE_DIR}/libs/${name}/src)
  endif()
  target_compile_definitions(${name}_test PRIVATE
    TRAVERSE_SOURCE_DIR="${CMAKE_SOURCE_DIR}" TRAVERSE_SHARE_DIR="${CMAKE_SOURCE_DIR}/share")
  target_link_libraries(${name}_test
    PRIVATE ${ARG_USES} GTest::gmock GTest::gtest_main traverse_build_flags
    traverse_test_flags)
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    set_target_properties(${name}_test PROPERTIES UNITY_BUILD ON)
    # In a source that includes others GCC takes what is internal to them for a header's.
    target_compile_options(${name}_test PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  traverse_precompile(${name}_test precompiled_for_tests HEADERS <gmock/gmock.h> <gtest/gtest.h>
    FLAGS GTest::gmock GTest::gtest traverse_build_flags traverse_test_flags)
  if(ARG_LABEL STREQUAL unit)
    add_dependencies(unit_tests ${name}_test)
  endif()
  if(ARG_LABEL MATCHES "^(unit|end-to-end)$")
    add_dependencies(sanitized_tests ${name}_test)
  endif()
  if(NOT ARG_SHARDS)
    add_test(NAME ${name} COMMAND ${name}_test ${filter})
    set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS ${ARG_LABEL})
    return()
  endif()
  math(EXPR last "${ARG_SHARDS} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${name}.${shard} COMMAND ${name}_test ${filter})
    # COST: the long ones first.
    set_tests_properties(${name}.${shard} PROPERTIES TIMEOUT ${ARG_TIMEOUT} COST 100
      LABELS ${ARG_LABEL}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
