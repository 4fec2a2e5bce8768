# `cpack` makes Debian packages of a build that is configured for the prefix /usr (the preset `package`): the libraries, what
# compiling against them needs, the command, and the Python module where it is built. What the binaries link to is found
# by dpkg-shlibdeps.
set(library_package "libpcl-fft-ground${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
string(TIMESTAMP release_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(STRINGS "${PROJECT_SOURCE_DIR}/package.xml" maintainer REGEX "<maintainer email=")
string(REGEX REPLACE ".*email=\"([^\"]*)\">([^<]*)<.*" "\\2 <\\1>" maintainer "${maintainer}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pcl-fft-ground)
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ground segmentation of 3D scans in the frequency domain")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
# In the system's own folders the libraries are found without a path.
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/remove_rpath.cmake")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL "")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/src")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# debian_package(<component> NAME <package> SECTION <section> TEXT <what is in it> [NEEDS <component>] [DEPENDS <relations>])
# Its copyright and its changelog lie where Debian wants them, and only in the package.
macro(debian_package component)
  cmake_parse_arguments(ARG "" "NAME;SECTION;TEXT;NEEDS;DEPENDS" "" ${ARGN})
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${ARG_NAME})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${ARG_SECTION})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${ARG_DEPENDS}")
  set(CPACK_COMPONENT_${upper}_DEPENDS ${ARG_NEEDS})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION
    "The low frequencies of a scan's elevation map are its ground, what stands\nabove them are objects.\n.\n${ARG_TEXT}")
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION share/doc/${ARG_NAME} RENAME copyright
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES "${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz" DESTINATION share/doc/${ARG_NAME}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

debian_package(library NAME ${library_package} SECTION libs
  TEXT "This package has the shared libraries: the core, the filters for the Point\nCloud Library, the alignment of scans and their simulation.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
  "${PROJECT_BINARY_DIR}/debian/triggers;${PROJECT_BINARY_DIR}/debian/shlibs")
file(WRITE "${PROJECT_BINARY_DIR}/debian/triggers" "activate-noawait ldconfig\n")
file(WRITE "${PROJECT_BINARY_DIR}/debian/shlibs" "")
foreach(component IN LISTS PCL_FFT_GROUND_COMPONENTS)
  file(APPEND "${PROJECT_BINARY_DIR}/debian/shlibs" "libpcl_fft_ground_${component} "
    "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library_package} (>= ${PROJECT_VERSION})\n")
endforeach()
if(PCL_FFT_GROUND_BUILD_FILTERS)
  set(development_needs "libpcl-dev (>= 1.12), libeigen3-dev (>= 3.4)")
else()
  set(development_needs "libeigen3-dev (>= 3.4)")
endif()
debian_package(development NAME libpcl-fft-ground-dev SECTION libdevel NEEDS library DEPENDS "${development_needs}"
  TEXT "This package has the headers and what CMake and pkg-config need to find the\nlibraries.")
if(PCL_FFT_GROUND_BUILD_TOOL)
  debian_package(tool NAME pcl-fft-ground SECTION science NEEDS library DEPENDS fonts-dejavu-core
    TEXT "This package has the command pcl_fft_ground: it segments scans, compares\nmethods, aligns scans and surveys, and simulates them.")
  set(CPACK_DEBIAN_TOOL_PACKAGE_SHLIBDEPS ON)
endif()
if(PCL_FFT_GROUND_BUILD_PYTHON)
  set(python "${PCL_FFT_GROUND_PYTHON_VERSION}")
  string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" python "${python}")
  math(EXPR next_minor "${CMAKE_MATCH_2} + 1")
  debian_package(python NAME python3-pcl-fft-ground SECTION python NEEDS library
    DEPENDS "python3 (>= ${python}), python3 (<< ${CMAKE_MATCH_1}.${next_minor}), python3-numpy"
    TEXT "This package has the Python module pcl_fft_ground, which works on NumPy\narrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
endif()

file(WRITE "${PROJECT_BINARY_DIR}/debian/changelog.Debian"
  "pcl-fft-ground (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
  "  * Version ${PROJECT_VERSION}.\n\n -- ${maintainer}  ${release_date}\n")
find_program(PCL_FFT_GROUND_GZIP gzip)
if(PCL_FFT_GROUND_GZIP)
  execute_process(COMMAND "${PCL_FFT_GROUND_GZIP}" -9nf "${PROJECT_BINARY_DIR}/debian/changelog.Debian")
endif()
include(CPack)
