# Shared by the scripts of these tests.

# Sets <result> to what follows "--" on the command line of the script: settings for the project to be configured.
function(arguments_after_dashes result)
  set(arguments "")
  set(seen_dashes FALSE)
  math(EXPR last "${CMAKE_ARGC} - 1")
  foreach(i RANGE ${last})
    if(seen_dashes)
      list(APPEND arguments "${CMAKE_ARGV${i}}")
    elseif("${CMAKE_ARGV${i}}" STREQUAL "--")
      set(seen_dashes TRUE)
    endif()
  endforeach()
  set(${result} "${arguments}" PARENT_SCOPE)
endfunction()

# run(<command>...): stops the test, with the whole output, if the command fails. Sets run_output.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()
