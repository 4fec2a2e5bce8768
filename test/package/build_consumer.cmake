# Configures, builds and runs the project SOURCE in BUILD with the package that lies in PACKAGE. With CXX_ONLY the
# configuration must be silent about our dependencies and must not have touched VTK or MPI.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

arguments_after_dashes(settings)
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BUILD}" --no-warn-unused-cli -G "${GENERATOR}" ${settings}
    "-Dpcl_fft_ground_DIR=${PACKAGE}")

if(CXX_ONLY)
  file(STRINGS "${BUILD}/CMakeCache.txt" traces REGEX "^(VTK_DIR|MPI_|CMAKE_C_COMPILER:)")
  if(traces)
    message(FATAL_ERROR "more than C++ and PCL's plain parts was looked for: ${traces}")
  endif()
  # CMake 3.16 cannot be kept from printing what PCL reports.
  if(CMAKE_VERSION VERSION_GREATER_EQUAL 3.17 AND run_output MATCHES "Found|Checking|[Ww]arning|WARNING")
    message(FATAL_ERROR "find_package(pcl_fft_ground) is not silent")
  endif()
endif()

run("${CMAKE_COMMAND}" --build "${BUILD}" --config "${CONFIG}")
get_filename_component(program "${SOURCE}" NAME)
find_program(executable "${program}" PATHS "${BUILD}" "${BUILD}/${CONFIG}" NO_DEFAULT_PATH)
run("${executable}")
