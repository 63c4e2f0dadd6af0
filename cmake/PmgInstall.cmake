# cmake --install: programs, their libraries that the distribution lacks, configuration, documents, man pages, shell completions; and the
# Debian packages pmg and pmg-dev of it (cpack --config BUILD/CPackConfig.cmake).
set(PMG_DOCUMENTS ${CMAKE_INSTALL_DATADIR}/doc/pmg)
install(FILES ${PMG_ONNXRUNTIME_LIBRARY} DESTINATION ${PMG_PRIVATE_LIBDIR} COMPONENT programs)
set(licences onnxruntime)
if(PMG_SIL)
  install(FILES ${PMG_MUJOCO_LIBRARY} DESTINATION ${PMG_PRIVATE_LIBDIR} COMPONENT programs)
  list(APPEND licences mujoco)
endif()
foreach(library IN LISTS licences)
  install(DIRECTORY ${PMG_THIRD_PARTY}/${library}/licences/ DESTINATION ${PMG_DOCUMENTS}/${library} COMPONENT programs)
endforeach()
if(PMG_ETHERCAT) # its terms ask for its sources beside the programs that contain it
  install(FILES third_party/licences/SOEM DESTINATION ${PMG_DOCUMENTS}/soem COMPONENT programs RENAME LICENSE)
  install(DIRECTORY third_party/prefix-soem/ DESTINATION ${PMG_DOCUMENTS}/soem/sources COMPONENT programs PATTERN complete EXCLUDE PATTERN win32 EXCLUDE)
endif()
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/pmg COMPONENT programs PATTERN "*.py" EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${PMG_DOCUMENTS} COMPONENT programs)
install(FILES cmake/copyright DESTINATION ${PMG_DOCUMENTS} COMPONENT programs)
install(DIRECTORY docs/ DESTINATION ${PMG_DOCUMENTS}/docs COMPONENT programs)
install(DIRECTORY examples/ DESTINATION ${PMG_DOCUMENTS}-dev/examples COMPONENT development PATTERN __pycache__ EXCLUDE)
install(FILES cmake/copyright DESTINATION ${PMG_DOCUMENTS}-dev COMPONENT development)

# At installation, because the programs are run for it.
get_property(programs DIRECTORY apps PROPERTY BUILDSYSTEM_TARGETS)
set(files)
foreach(program IN LISTS programs)
  get_target_property(type ${program} TYPE)
  if(type STREQUAL EXECUTABLE)
    list(APPEND files ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${program})
  endif()
endforeach()
install(CODE "execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/manuals.py
  \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR} ${PROJECT_VERSION} ${files} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT programs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pmg)
set(CPACK_PACKAGE_CONTACT "PMG's maintainers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL programs development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME pmg)
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "onboard controller for humanoids: motion generator, simulation, tools
 Programs, robots, scenarios and documents of PMG, the parameterized motion generator.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PMG_THIRD_PARTY}/mujoco/lib ${PMG_THIRD_PARTY}/onnxruntime/lib)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "ffmpeg, libosmesa6") # films
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME pmg-dev)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "onboard controller for humanoids: CMake package
 The header-only motion generator, the reader of robots and clip libraries, and the controller for a backend of one's own.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "pmg (= ${PROJECT_VERSION}), cmake, pkg-config, libeigen3-dev, libyaml-cpp-dev, libfmt-dev, \
liborocos-kdl-dev, liburdfdom-dev, libconsole-bridge-dev, libssl-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libceres-dev, libboost-dev, libcli11-dev, liblcm-dev, libspdlog-dev, nlohmann-json3-dev, \
zlib1g-dev, libzstd-dev, libsdl2-dev, libglfw3-dev, libosmesa6-dev, libturbojpeg0-dev, libnlopt-cxx-dev, libnlopt-dev, libpagmo-dev")
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
include(CPack)
