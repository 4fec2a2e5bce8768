# Installs the headers and what find_package(pcl_fft_ground) needs, and writes the same package into the build tree.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pcl_fft_ground")
get_property(PCL_FFT_GROUND_COMPONENTS GLOBAL PROPERTY PCL_FFT_GROUND_COMPONENTS)

# A static library leaves what it uses in private for its consumers to link.
set(PCL_FFT_GROUND_CONSUMERS_NEED_FFTW OFF)
get_target_property(core_type pcl_fft_ground_core TYPE)
if(PCL_FFT_GROUND_WITH_FFTW AND core_type STREQUAL "STATIC_LIBRARY")
  set(PCL_FFT_GROUND_CONSUMERS_NEED_FFTW ON)
endif()

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/pcl_fft_groundConfig.cmake.in" "${PROJECT_BINARY_DIR}/pcl_fft_groundConfig.cmake"
  INSTALL_DESTINATION "${package_dir}"
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pcl_fft_groundConfigVersion.cmake"
  VERSION ${PROJECT_VERSION}
  COMPATIBILITY SameMajorVersion) # sources for 0.1 build with 0.2; libraries differ by SOVERSION
install(FILES
  "${PROJECT_BINARY_DIR}/pcl_fft_groundConfig.cmake"
  "${PROJECT_BINARY_DIR}/pcl_fft_groundConfigVersion.cmake"
  DESTINATION "${package_dir}" COMPONENT development)

# pcl_fft_ground_<component>.pc, for those who build without CMake. PCL's own have its version in their names, or not.
find_package(PkgConfig QUIET)
set(pcl_suffix "")
if(PKG_CONFIG_FOUND AND PCL_FOUND)
  pkg_check_modules(PCL_FFT_GROUND_PC QUIET pcl_common)
  if(NOT PCL_FFT_GROUND_PC_FOUND)
    set(pcl_suffix "-${PCL_VERSION_MAJOR}.${PCL_VERSION_MINOR}")
  endif()
endif()
set(requires_core eigen3)
set(requires_simulation pcl_fft_ground_core)
set(requires_filters pcl_fft_ground_core pcl_common${pcl_suffix} pcl_filters${pcl_suffix} pcl_sample_consensus${pcl_suffix})
set(requires_registration pcl_fft_ground_filters pcl_kdtree${pcl_suffix} pcl_search${pcl_suffix} pcl_registration${pcl_suffix})
if(PCL_FFT_GROUND_CONSUMERS_NEED_FFTW)
  list(APPEND requires_core fftw3 fftw3f)
endif()
file(RELATIVE_PATH prefix_from_pc "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")

foreach(component IN LISTS PCL_FFT_GROUND_COMPONENTS)
  set(targets pcl_fft_ground_${component}Targets)
  install(EXPORT ${targets} NAMESPACE pcl_fft_ground:: DESTINATION "${package_dir}" COMPONENT development)
  export(EXPORT ${targets} NAMESPACE pcl_fft_ground:: FILE "${PROJECT_BINARY_DIR}/${targets}.cmake")

  string(REPLACE ";" " " requires "${requires_${component}}")
  set(static_define "")
  if(core_type STREQUAL "STATIC_LIBRARY")
    string(TOUPPER " -DPCL_FFT_GROUND_${component}_STATIC_DEFINE" static_define)
  endif()
  file(WRITE "${PROJECT_BINARY_DIR}/pkgconfig/pcl_fft_ground_${component}.pc"
    "prefix=\${pcfiledir}/${prefix_from_pc}\nlibdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}\n"
    "includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}\n\n"
    "Name: pcl_fft_ground_${component}\nDescription: ${PROJECT_DESCRIPTION}\nVersion: ${PROJECT_VERSION}\n"
    "Requires: ${requires}\nLibs: -L\${libdir} -lpcl_fft_ground_${component}\n"
    "Cflags: -I\${includedir}${static_define}\n")
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/pcl_fft_ground_${component}.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
endforeach()

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/pcl_fft_ground" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(FILES "${PROJECT_BINARY_DIR}/include/pcl_fft_ground/version.h"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/pcl_fft_ground" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/package.xml" DESTINATION "${CMAKE_INSTALL_DATADIR}/pcl_fft_ground" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT license)
if(PCL_FFT_GROUND_TOP_LEVEL)
  include(PclFftGroundDebian)
endif()
