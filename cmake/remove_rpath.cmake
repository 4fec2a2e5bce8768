# Run by cpack before it makes a package: removes the search path of the staged binaries.
file(GLOB_RECURSE binaries "${CPACK_TEMPORARY_DIRECTORY}/*")
list(FILTER binaries INCLUDE REGEX "/bin/[^/]*$|\\.so[0-9.]*$")
foreach(binary IN LISTS binaries)
  if(NOT IS_SYMLINK "${binary}")
    file(RPATH_REMOVE FILE "${binary}")
  endif()
endforeach()
