# Does in BUILD what the tutorial PAGE says: the program of its blocks of C++ and CMake is built with the package in PACKAGE
# and works on the scan that TOOL simulates; TOOL's command lines are run as they stand there.
include("${CMAKE_CURRENT_LIST_DIR}/script_arguments.cmake")

# code_block(<result> <language>): the first block of code in a language.
function(code_block result language)
  file(READ "${PAGE}" text)
  string(FIND "${text}" "```${language}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${PAGE} has no block of ${language}")
  endif()
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n" begin)
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${result} "${text}\n" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY "${BUILD}/source")
code_block(program cpp)
code_block(project cmake)
file(WRITE "${BUILD}/source/main.cpp.new" "${program}")
file(WRITE "${BUILD}/source/CMakeLists.txt.new" "${project}")
foreach(name IN ITEMS main.cpp CMakeLists.txt)
  configure_file("${BUILD}/source/${name}.new" "${BUILD}/source/${name}" COPYONLY)
endforeach()

arguments_after_dashes(settings)
run("${CMAKE_COMMAND}" -S "${BUILD}/source" -B "${BUILD}/build" --no-warn-unused-cli -G "${GENERATOR}" ${settings}
    "-Dpcl_fft_ground_DIR=${PACKAGE}")
run("${CMAKE_COMMAND}" --build "${BUILD}/build" --config "${CONFIG}")

file(STRINGS "${PAGE}" commands REGEX "^pcl_fft_ground ")
foreach(command IN LISTS commands)
  separate_arguments(words UNIX_COMMAND "${command}")
  list(REMOVE_AT words 0)
  run("${CMAKE_COMMAND}" -E chdir "${BUILD}" "${TOOL}" ${words})
endforeach()
if(NOT EXISTS "${BUILD}/result/report.html")
  message(FATAL_ERROR "the tutorial's commands made no report: ${commands}")
endif()
find_program(executable tutorial PATHS "${BUILD}/build" "${BUILD}/build/${CONFIG}" NO_DEFAULT_PATH)
run("${executable}" "${BUILD}/wreck.pcd")
