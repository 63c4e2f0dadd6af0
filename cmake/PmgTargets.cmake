# The project's target functions. Flags: baseline x86-64 everywhere, because -march=native or AVX changes Eigen's alignment, and with it the
# ABI of the distribution's KDL.

if(NOT CMAKE_BUILD_TYPE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Paths from the build folder on, so that another clone of the same sources finds its objects there, whatever its place.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=true ${CCACHE_PROGRAM})
endif()

include(PmgSanitize)

# GCC collects its own garbage from 128 MiB on, again and again. A source needs 300 to 900 MiB here; collecting later saves 5 to 13 % of its time.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options("SHELL:--param ggc-min-heapsize=600000")  # KiB
endif()

add_library(pmg_warnings INTERFACE)
target_compile_options(pmg_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wnon-virtual-dtor -Wold-style-cast)
if(PMG_UNITY)  # it takes a source that is compiled with others for a header, whose types two sources could define differently
  target_compile_options(pmg_warnings INTERFACE -Wno-subobject-linkage)
endif()
if(PMG_WARNINGS_AS_ERRORS)
  target_compile_options(pmg_warnings INTERFACE -Werror)
endif()

# pmg_add_room(NAME SOURCES... LINK targets...): the static library pmg_room_NAME from src/NAME. Includes are relative to src/: #include
# "model/robot_model.hpp".
function(pmg_add_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(pmg_room_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(pmg_room_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${PMG_ROOM_HEADERS}>)
  target_link_libraries(pmg_room_${name} PUBLIC ${ROOM_LINK} PRIVATE ${ROOM_PRIVATE_LINK} pmg_warnings)
  pmg_use_common_headers(pmg_room_${name} rooms)
endfunction()

# The sources of programs and tests only parse, compose and compare: they are hardly optimised. The rooms that they call are.
if(CMAKE_BUILD_TYPE STREQUAL Release)
  set(PMG_QUICK_OPTIONS -O1)
endif()

# pmg_add_app(NAME SOURCES... LINK targets...): the executable bin/NAME from apps/NAME.cpp and these. The target `programs` builds all of these.
if(PMG_PROGRAMS)
  add_custom_target(programs)
endif()
function(pmg_add_app name)
  cmake_parse_arguments(APP "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${name}.cpp ${APP_SOURCES})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  target_link_libraries(${name} PRIVATE pmg_program ${APP_LINK} pmg_warnings)
  target_compile_options(${name} PRIVATE ${PMG_QUICK_OPTIONS})
  pmg_use_common_headers(${name} programs)
  add_dependencies(programs ${name})
endfunction()

# LeakSanitizer's options for every test. intercept_tls_get_addr=0: the runtime of GCC 12 and 13 reads a header before a thread's
# memory that glibc has not written there since 2.25, and then crashes (google/sanitizers 1322); GCC 14 no longer needs it.
set(PMG_LSAN_OPTIONS "suppressions=${PROJECT_SOURCE_DIR}/test/lsan.supp:print_suppressions=0:intercept_tls_get_addr=0")

# pmg_add_test(NAME SOURCES... LINK targets... [SLOW tests...] [REALTIME tests...]): the GoogleTest executable test_NAME; one ctest entry per
# TEST, run from the source root. SLOW and REALTIME take patterns as --gtest_filter does, * for all, and give these tests a label: slow, what
# .ci/run leaves out for its time; realtime, what has threads, processes, sockets or windows work against a clock, and .ci/run tries alone.
function(pmg_add_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINK;SLOW;REALTIME" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_link_libraries(test_${name} PRIVATE ${TEST_LINK} test_folders GTest::gtest GTest::gmock GTest::gtest_main pmg_warnings)
  target_compile_options(test_${name} PRIVATE ${PMG_QUICK_OPTIONS})
  pmg_use_common_headers(test_${name} tests)
  if(NOT "${TEST_SLOW}" STREQUAL "*")
    pmg_needed_in_ci(test_${name})
  endif()
  foreach(pattern ${TEST_SLOW} ${TEST_REALTIME})
    set_property(GLOBAL APPEND_STRING PROPERTY PMG_LABELLED_TESTS "test_${name} ${pattern}\n")
  endforeach()
  list(JOIN TEST_SLOW ":" slow)
  list(JOIN TEST_REALTIME ":" realtime)
  pmg_discover_tests(${name} quick "*-${slow}:${realtime}")
  if(slow)
    pmg_discover_tests(${name} slow "${slow}" LABELS slow)
  endif()
  if(realtime)
    pmg_discover_tests(${name} realtime "${realtime}" LABELS realtime)
  endif()
endfunction()

# pmg_needed_in_ci(TARGETS...): .ci/run builds these, as the target `ci_programs`, and not what `slow` tests alone run.
if(NOT TARGET ci_programs AND PMG_BUILD_TESTS)
  add_custom_target(ci_programs)
endif()
function(pmg_needed_in_ci)
  add_dependencies(ci_programs ${ARGN})
endfunction()

# pmg_discover_tests(NAME LIST FILTER [properties...]): those tests of test_NAME that the filter lets through.
function(pmg_discover_tests name which filter)
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." TEST_FILTER "${filter}" TEST_LIST ${name}_${which} NO_PRETTY_VALUES
                       WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 300 ENVIRONMENT "LSAN_OPTIONS=${PMG_LSAN_OPTIONS}" ${ARGN})
endfunction()

# fuzz_<room> decodes whatever a bus says, from decoding_fuzzer.cpp; the test <room>.fuzz gives it so many seeded random inputs. Clang: libFuzzer,
# fuzz_<room> CORPUS; other compilers: decoding_fuzzer_run.cpp. A third argument NAME: fuzz_<room>_NAME and <room>.fuzz_NAME from NAME_fuzzer.cpp.
function(pmg_add_fuzzer room runs)
  set(fuzzer fuzz_${room})
  set(test ${room}.fuzz)
  set(source decoding)
  if(ARGC GREATER 2)
    string(APPEND fuzzer _${ARGV2})
    string(APPEND test _${ARGV2})
    set(source ${ARGV2})
  endif()
  add_executable(${fuzzer} ${source}_fuzzer.cpp)
  target_include_directories(${fuzzer} PRIVATE ${CMAKE_SOURCE_DIR}/test)
  target_link_libraries(${fuzzer} PRIVATE pmg_room_${room} test_folders pmg_warnings)
  pmg_needed_in_ci(${fuzzer})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    target_compile_options(${fuzzer} PRIVATE -fsanitize=fuzzer)
    target_link_options(${fuzzer} PRIVATE -fsanitize=fuzzer)
    add_test(NAME ${test} COMMAND ${fuzzer} -runs=${runs} -seed=1)
  else()
    target_sources(${fuzzer} PRIVATE ${source}_fuzzer_run.cpp)
    add_test(NAME ${test} COMMAND ${fuzzer} ${runs})
  endif()
endfunction()
