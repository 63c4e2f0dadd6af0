cmake_minimum_required(VERSION 3.22)
# Script: writes HEADER with VERSION and the git revision of SOURCE_DIR, and "-dirty" if files differ from it. A source tree without git gives
# only the version.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
set(version ${VERSION})
if(failed EQUAL 0)
  set(version "${VERSION}+${revision}")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define PMG_SOFTWARE_VERSION \"@version@\"\n" @ONLY)
