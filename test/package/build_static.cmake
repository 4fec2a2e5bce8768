# Builds SOURCE as static libraries in BUILD, without the command, tests and examples.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

arguments_after_dashes(settings)
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BUILD}" --no-warn-unused-cli -G "${GENERATOR}" ${settings}
    -DBUILD_SHARED_LIBS=OFF -DPCL_FFT_GROUND_BUILD_TOOL=OFF
    -DPCL_FFT_GROUND_BUILD_TESTS=OFF -DPCL_FFT_GROUND_BUILD_EXAMPLES=OFF)
run("${CMAKE_COMMAND}" --build "${BUILD}" --config "${CONFIG}")
