# Installs BUILD to PREFIX, renames that to MOVED_TO if given, and checks that no CMake file knows where it was made.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

file(REMOVE_RECURSE "${PREFIX}" "${MOVED_TO}")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}" --config "${CONFIG}")
set(package "${PREFIX}")
if(MOVED_TO)
  file(RENAME "${PREFIX}" "${MOVED_TO}")
  set(package "${MOVED_TO}")
endif()

file(GLOB_RECURSE cmake_files "${package}/*.cmake" "${package}/*.pc")
list(LENGTH cmake_files file_count)
if(file_count LESS 4)
  message(FATAL_ERROR "only ${file_count} CMake files below ${package}")
endif()
foreach(file IN LISTS cmake_files)
  file(READ "${file}" text)
  # CMake's own way of telling that /usr was reached by a link from /.
  string(REGEX REPLACE "(_realOrig|_IMPORT_PREFIX|PACKAGE_PREFIX_DIR) \"/usr[^\n]*\n" "" text "${text}")
  foreach(place IN ITEMS "${PREFIX}" "${BUILD}" "${SOURCE}" "/usr/lib/" "/usr/include/" "/usr/local/")
    string(FIND "${text}" "${place}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} holds a path of the machine that made it: ${place}")
    endif()
  endforeach()
endforeach()

# The program, where there is one, finds its libraries in the new place.
if(EXISTS "${package}/bin/pcl_fft_ground")
  run("${package}/bin/pcl_fft_ground" --version)
endif()
