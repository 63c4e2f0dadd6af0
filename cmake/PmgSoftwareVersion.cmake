# pmg_software_version: a header with version and git revision, so that a log identifies the code that ran. Made at every build; rewritten
# only if they change.
set(PMG_VERSION_HEADER ${PROJECT_BINARY_DIR}/software_version/software_version.hpp)
add_custom_target(pmg_software_version_header
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION} -DHEADER=${PMG_VERSION_HEADER}
          -P ${CMAKE_CURRENT_LIST_DIR}/write_software_version.cmake
  BYPRODUCTS ${PMG_VERSION_HEADER})
add_library(pmg_software_version INTERFACE)
target_include_directories(pmg_software_version INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/software_version>)
add_dependencies(pmg_software_version pmg_software_version_header)
