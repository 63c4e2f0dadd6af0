# The package `pmg` for projects outside this tree: find_package(pmg COMPONENTS ...), of an installed prefix (lib/cmake/pmg) or of this build
# tree (-Dpmg_DIR=BUILD); FetchContent and add_subdirectory give the same targets, but for the controller. docs/how-to/embedding.md.
#   pmg::generator   the motion generator, header-only; needs Eigen
#   pmg::clips       reads robots and clip libraries
#   pmg::controller  pmg_controller but its main(), for a backend of one's own
include(GNUInstallDirs)
set(PMG_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/pmg)
set(PMG_ROOM_HEADERS ${CMAKE_INSTALL_INCLUDEDIR}/pmg-rooms) # of everything but the generator, whose are include/pmg
set(PMG_PRIVATE_LIBDIR ${CMAKE_INSTALL_LIBDIR}/pmg)         # rooms, MuJoCo, ONNX Runtime: nobody else's business

# Programs find their libraries from where they are: a prefix can be moved.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${PMG_PRIVATE_LIBDIR}")

# In the build tree a program finds config/ as in a prefix: bin/../share/pmg.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/config ${PROJECT_BINARY_DIR}/share/pmg SYMBOLIC)

# pmg_linked(OUT TARGET): the target, and every target of this build that it links.
function(pmg_linked out target)
  set(found ${target})
  set(open ${target})
  while(open)
    list(POP_FRONT open here)
    get_target_property(links ${here} INTERFACE_LINK_LIBRARIES)
    foreach(link IN LISTS links)
      string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
      if(NOT TARGET "${link}" OR "${link}" IN_LIST found)
        continue()
      endif()
      get_target_property(imported ${link} IMPORTED)
      if(NOT imported)
        list(APPEND found ${link})
        list(APPEND open ${link})
      endif()
    endforeach()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# pmg_component(NAME TARGET): the target is pmg::NAME of the package, with what it links beyond the components before.
function(pmg_component name target)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  if(NOT TARGET pmg::${name})
    add_library(pmg::${name} ALIAS ${target})
  endif()
  pmg_linked(targets ${target})
  get_property(before GLOBAL PROPERTY PMG_PACKAGED)
  list(REMOVE_ITEM targets ${before})
  set_property(GLOBAL APPEND PROPERTY PMG_PACKAGED ${targets})
  set_property(GLOBAL APPEND PROPERTY PMG_COMPONENTS ${name})
  install(TARGETS ${targets} EXPORT pmg-${name} ARCHIVE DESTINATION ${PMG_PRIVATE_LIBDIR} COMPONENT development)
  install(EXPORT pmg-${name} NAMESPACE pmg:: FILE pmg-${name}.cmake DESTINATION ${PMG_PACKAGE_DIR} COMPONENT development)
  export(EXPORT pmg-${name} NAMESPACE pmg:: FILE ${PROJECT_BINARY_DIR}/pmg-${name}.cmake)
endfunction()

# pmg_package(): the package's own files, after its components.
function(pmg_package)
  include(CMakePackageConfigHelpers)
  get_property(components GLOBAL PROPERTY PMG_COMPONENTS)
  string(REPLACE ";" "|" component_pattern "${components}")
  string(REPLACE ";" ", " components "${components}")
  set(version ${PROJECT_BINARY_DIR}/pmg-config-version.cmake)
  write_basic_package_version_file(${version} VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)

  set(place "set(pmg_CONFIG_DIR ${PROJECT_SOURCE_DIR}/config)\nset(pmg_cmake ${PROJECT_SOURCE_DIR}/cmake)")
  configure_file(${PROJECT_SOURCE_DIR}/cmake/pmg-config.cmake.in ${PROJECT_BINARY_DIR}/pmg-config.cmake @ONLY)

  file(RELATIVE_PATH up /${PMG_PACKAGE_DIR} /)
  string(CONCAT place "get_filename_component(pmg_PREFIX \${CMAKE_CURRENT_LIST_DIR}/${up} ABSOLUTE)\n"
                      "set(pmg_CONFIG_DIR \${pmg_PREFIX}/${CMAKE_INSTALL_DATADIR}/pmg)\n"
                      "set(pmg_cmake \${CMAKE_CURRENT_LIST_DIR})\n"
                      "set(PMG_PRIVATE_LIBRARIES \${pmg_PREFIX}/${PMG_PRIVATE_LIBDIR})")
  configure_file(${PROJECT_SOURCE_DIR}/cmake/pmg-config.cmake.in ${PROJECT_BINARY_DIR}/installed/pmg-config.cmake @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/installed/pmg-config.cmake ${version} ${PROJECT_SOURCE_DIR}/cmake/PmgDependencies.cmake
                ${PROJECT_SOURCE_DIR}/cmake/PmgSanitize.cmake
          DESTINATION ${PMG_PACKAGE_DIR} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/pmg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/ DESTINATION ${PMG_ROOM_HEADERS} COMPONENT development FILES_MATCHING PATTERN "*.hpp")
endfunction()
