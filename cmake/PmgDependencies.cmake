# Finds every external library, once, for this build and for a project outside it that uses it (PmgPackage.cmake): those of the components in
# PMG_PARTS. Libraries come from the distribution unless third_party/ has them; scripts/setup installs them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
if(PMG_PARTS STREQUAL generator)
  return()
endif()

# pmg::clips
find_package(PkgConfig REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(orocos_kdl REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(console_bridge REQUIRED) # urdfdom's log: what it says of a file is heard there
pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)
if(NOT TARGET yaml-cpp::yaml-cpp) # yaml-cpp 0.7 and earlier export the bare name
  add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
endif()
if(NOT TARGET pmg_kdl) # KDL's package file defines no target
  add_library(pmg_kdl INTERFACE IMPORTED GLOBAL)
  target_include_directories(pmg_kdl SYSTEM INTERFACE ${orocos_kdl_INCLUDE_DIRS})
  target_link_libraries(pmg_kdl INTERFACE ${orocos_kdl_LIBRARIES} Eigen3::Eigen)
endif()
if(NOT "controller" IN_LIST PMG_PARTS)
  return()
endif()

# pmg::controller, and every program
find_package(Threads REQUIRED)
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter) # its standard library alone: tables of the messages, tests of scripts
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Ceres REQUIRED)
find_package(Boost REQUIRED) # headers: wait-free queues between threads, and Beast
find_package(OpenSSL REQUIRED COMPONENTS Crypto SSL) # with TLS, for web pages
find_package(spdlog REQUIRED)
find_package(ZLIB REQUIRED) # npz files of motion capture
pkg_check_modules(SDL2 REQUIRED IMPORTED_TARGET sdl2>=2.26) # game controllers
add_library(pmg_sdl INTERFACE)
target_link_libraries(pmg_sdl INTERFACE PkgConfig::SDL2)
if(PMG_SIL) # for simulation and calibration
  find_package(glfw3 REQUIRED)
  pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd) # chunks of MCAP files
  pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)
  pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg) # pictures of a simulated camera
  pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt_cxx)
  find_path(PAGMO_INCLUDE_DIR pagmo/pagmo.hpp REQUIRED)
  find_library(PAGMO_LIBRARY pagmo REQUIRED)
endif()
if(PMG_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
  include(GoogleTest)
endif()

# LCM before 1.4 has no package file for CMake, and its pkg-config file requires GLib's development files, which nothing here needs.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
add_library(pmg_lcm INTERFACE IMPORTED GLOBAL)
target_include_directories(pmg_lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(pmg_lcm INTERFACE ${LCM_LIBRARY})

# pagmo's package file asks for libraries that CMA-ES doesn't need; one source file of the calibration includes it.
if(PMG_SIL)
  add_library(pmg_pagmo INTERFACE IMPORTED GLOBAL)
  target_include_directories(pmg_pagmo SYSTEM INTERFACE ${PAGMO_INCLUDE_DIR})
  target_link_libraries(pmg_pagmo INTERFACE ${PAGMO_LIBRARY} boost_serialization Threads::Threads)
endif()

# MuJoCo 2.2.2, ONNX Runtime 1.21 and uPlot: an installed prefix has the libraries (PMG_PRIVATE_LIBRARIES); else third_party/fetch checks them
# and unpacks them into third_party/prefix. It does nothing if the pinned versions are there.
if(PMG_PRIVATE_LIBRARIES)
  set(PMG_MUJOCO_LIBRARY ${PMG_PRIVATE_LIBRARIES}/libmujoco.so.2.2.2)
  set(PMG_ONNXRUNTIME_LIBRARY ${PMG_PRIVATE_LIBRARIES}/libonnxruntime.so.1)
else()
  set(PMG_THIRD_PARTY ${CMAKE_CURRENT_LIST_DIR}/../third_party/prefix)
  execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/../third_party/fetch RESULT_VARIABLE fetched)
  if(NOT fetched EQUAL 0)
    message(FATAL_ERROR "third_party/fetch failed; see its message above")
  endif()
  set(PMG_MUJOCO_LIBRARY ${PMG_THIRD_PARTY}/mujoco/lib/libmujoco.so.2.2.2)
  set(PMG_MUJOCO_HEADERS ${PMG_THIRD_PARTY}/mujoco/include)
  set(PMG_ONNXRUNTIME_LIBRARY ${PMG_THIRD_PARTY}/onnxruntime/lib/libonnxruntime.so.1)
  set(PMG_ONNXRUNTIME_HEADERS ${PMG_THIRD_PARTY}/onnxruntime/include)
endif()

if(PMG_SIL)
  add_library(pmg_mujoco SHARED IMPORTED GLOBAL)
  set_target_properties(pmg_mujoco PROPERTIES IMPORTED_LOCATION ${PMG_MUJOCO_LIBRARY} IMPORTED_SONAME libmujoco.so.2.2.2)
  target_include_directories(pmg_mujoco SYSTEM INTERFACE ${PMG_MUJOCO_HEADERS})
endif()

add_library(pmg_onnxruntime SHARED IMPORTED GLOBAL)
set_target_properties(pmg_onnxruntime PROPERTIES IMPORTED_LOCATION ${PMG_ONNXRUNTIME_LIBRARY} IMPORTED_SONAME libonnxruntime.so.1)
target_include_directories(pmg_onnxruntime SYSTEM INTERFACE ${PMG_ONNXRUNTIME_HEADERS})
