# Headers that most sources include, compiled once for rooms, once for programs and once for tests. A compiler cache gains more without them:
# it takes no object over from another folder whose precompiled headers differ.
set(PMG_PRECOMPILE_DEFAULT ON)
if(CCACHE_PROGRAM)
  set(PMG_PRECOMPILE_DEFAULT OFF)
endif()
option(PMG_PRECOMPILED_HEADERS "Compile common headers once (default: without a compiler cache)" ${PMG_PRECOMPILE_DEFAULT})

# GCC 12 forgets with precompiled headers that <string> is a system header, and reports its copies of characters as out of bounds.
if(PMG_PRECOMPILED_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(pmg_warnings INTERFACE -Wno-array-bounds -Wno-stringop-overflow)
endif()

set(PMG_STANDARD_HEADERS <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <numbers> <optional> <random>
  <span> <sstream> <string> <string_view> <utility> <variant> <vector> <Eigen/Dense>)

# pmg_common_headers(KIND [EXECUTABLES] LINK targets... HEADERS headers...): compiles the headers as sources of this kind are compiled.
function(pmg_common_headers kind)
  cmake_parse_arguments(COMMON "EXECUTABLES" "" "LINK;HEADERS" ${ARGN})
  if(NOT PMG_PRECOMPILED_HEADERS)
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/common_headers/${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Compiled for its headers alone.\n")
  add_library(pmg_headers_of_${kind} OBJECT EXCLUDE_FROM_ALL ${source})
  target_link_libraries(pmg_headers_of_${kind} PRIVATE Eigen3::Eigen ${COMMON_LINK} pmg_warnings)
  if(COMMON_EXECUTABLES)
    set_target_properties(pmg_headers_of_${kind} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(pmg_headers_of_${kind} PRIVATE -fPIE ${PMG_QUICK_OPTIONS}) # -fPIE: as CMake compiles an executable's sources
  endif()
  target_precompile_headers(pmg_headers_of_${kind} PRIVATE ${PMG_STANDARD_HEADERS} ${COMMON_HEADERS})
endfunction()

# pmg_use_common_headers(TARGET KIND)
function(pmg_use_common_headers target kind)
  if(TARGET pmg_headers_of_${kind})
    target_precompile_headers(${target} REUSE_FROM pmg_headers_of_${kind})
  endif()
endfunction()

pmg_common_headers(rooms)
pmg_common_headers(programs EXECUTABLES LINK CLI11::CLI11 nlohmann_json::nlohmann_json HEADERS <CLI/CLI.hpp> <nlohmann/json.hpp>)
if(PMG_BUILD_TESTS)
  pmg_common_headers(tests EXECUTABLES LINK GTest::gtest GTest::gmock nlohmann_json::nlohmann_json
                     HEADERS <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>)
endif()
