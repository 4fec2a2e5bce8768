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
  COMPATIBILITY SameMinorVersion) # until 1.0, a minor version may break
install(FILES
  "${PROJECT_BINARY_DIR}/pcl_fft_groundConfig.cmake"
  "${PROJECT_BINARY_DIR}/pcl_fft_groundConfigVersion.cmake"
  DESTINATION "${package_dir}")

foreach(component IN LISTS PCL_FFT_GROUND_COMPONENTS)
  set(targets pcl_fft_ground_${component}Targets)
  install(EXPORT ${targets} NAMESPACE pcl_fft_ground:: DESTINATION "${package_dir}")
  export(EXPORT ${targets} NAMESPACE pcl_fft_ground:: FILE "${PROJECT_BINARY_DIR}/${targets}.cmake")
endforeach()

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/pcl_fft_ground" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(FILES "${PROJECT_BINARY_DIR}/include/pcl_fft_ground/version.h"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/pcl_fft_ground")
install(FILES "${PROJECT_SOURCE_DIR}/package.xml" DESTINATION "${CMAKE_INSTALL_DATADIR}/pcl_fft_ground")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
