# Compiles SOURCE to PROGRAM with what pkg-config says of MODULE, found in PKG_CONFIG, and runs it.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

set(ENV{PKG_CONFIG_PATH} "${PKG_CONFIG}")
run(pkg-config --modversion "${MODULE}")
if(NOT run_output MATCHES "^${VERSION}\n")
  message(FATAL_ERROR "not ${VERSION}: ${run_output}")
endif()
run(pkg-config --cflags --libs "${MODULE}")
separate_arguments(flags UNIX_COMMAND "${run_output}")
get_filename_component(libraries "${PKG_CONFIG}" DIRECTORY)
run("${COMPILER}" -std=c++17 "${SOURCE}" -o "${PROGRAM}" ${flags} "-Wl,-rpath,${libraries}")
run("${PROGRAM}")
