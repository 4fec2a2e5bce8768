# cmake -DSOURCE=<checkout> -DHEADER=<generated version.h> -DVERSION=<of project()> -P cmake/check_version.cmake
# Fails unless the generated header, package.xml and the newest entry of CHANGELOG.md give the version of project().

# first_version(<result> <file> <regex>): the first x.y.z in a line of the file that matches.
function(first_version result file regex)
  file(STRINGS "${file}" lines REGEX "${regex}")
  list(GET lines 0 line)
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" version "${line}")
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

first_version(header "${HEADER}" "define PCL_FFT_GROUND_VERSION \"")
first_version(package_xml "${SOURCE}/package.xml" "<version>")
first_version(changelog "${SOURCE}/CHANGELOG.md" "^## .[0-9]")
foreach(place IN ITEMS header package_xml changelog)
  if(NOT "${${place}}" STREQUAL VERSION)
    message(FATAL_ERROR "project() says ${VERSION}, ${place} says '${${place}}'")
  endif()
endforeach()
