# Configures the project SOURCE with the package in PACKAGE; that must fail, with a message that matches EXPECT.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

arguments_after_dashes(settings)
file(REMOVE_RECURSE "${BUILD}")
execute_process(
  COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BUILD}" --no-warn-unused-cli -G "${GENERATOR}" ${settings}
    "-Dpcl_fft_ground_DIR=${PACKAGE}"
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
string(REGEX REPLACE "[ \n]+" " " output "${output}") # CMake wraps its messages
if(status EQUAL 0)
  message(FATAL_ERROR "the package was accepted")
elseif(NOT output MATCHES "${EXPECT}")
  message(FATAL_ERROR "the message does not say: ${EXPECT}")
endif()
