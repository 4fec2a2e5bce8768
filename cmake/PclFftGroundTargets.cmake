# Helpers that give every target of the project the same language level, warnings, visibility and sanitizers.

# pcl_fft_ground_compile_settings(<target>): settings that stay private to the project.
function(pcl_fft_ground_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(PCL_FFT_GROUND_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(PCL_FFT_GROUND_SANITIZERS)
    target_compile_options(${target} PRIVATE -fsanitize=${PCL_FFT_GROUND_SANITIZERS} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${PCL_FFT_GROUND_SANITIZERS})
  endif()
  if(PCL_FFT_GROUND_COVERAGE)
    target_link_options(${target} PUBLIC --coverage)
  endif()
endfunction()

# pcl_fft_ground_count_lines(<target>): lets it count how often its lines run, where that was asked for.
function(pcl_fft_ground_count_lines target)
  if(PCL_FFT_GROUND_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
  endif()
endfunction()

# pcl_fft_ground_library(<name> EXPORT_HEADER <path> SOURCES <file>...)
# Library pcl_fft_ground_<name>, known as pcl_fft_ground::<name> here and to consumers, with hidden visibility and
# a generated export header included as <pcl_fft_ground/path>. Each library has an export set of its own, so that
# find_package(pcl_fft_ground COMPONENTS core) need not look for what the others link to.
function(pcl_fft_ground_library name)
  cmake_parse_arguments(ARG "" "EXPORT_HEADER" "SOURCES" ${ARGN})
  set(target pcl_fft_ground_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(pcl_fft_ground::${name} ALIAS ${target})
  pcl_fft_ground_compile_settings(${target})
  pcl_fft_ground_count_lines(${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    INSTALL_RPATH "$ORIGIN")

  include(GenerateExportHeader)
  string(TOUPPER ${target} prefix)
  set(generated "${PROJECT_BINARY_DIR}/include/pcl_fft_ground/${ARG_EXPORT_HEADER}")
  generate_export_header(${target} BASE_NAME ${prefix} EXPORT_FILE_NAME "${generated}")
  get_target_property(kind ${target} TYPE)
  if(kind STREQUAL "STATIC_LIBRARY")
    target_compile_definitions(${target} PUBLIC ${prefix}_STATIC_DEFINE)
  elseif(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT PCL_FFT_GROUND_SANITIZERS)
    # What a library uses but does not link to is an error here, not in the consumer's program.
    target_link_options(${target} PRIVATE LINKER:--no-undefined)
  endif()
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

  get_filename_component(header_dir "${ARG_EXPORT_HEADER}" DIRECTORY)
  install(FILES "${generated}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/pcl_fft_ground/${header_dir}"
    COMPONENT development)
  install(TARGETS ${target} EXPORT ${target}Targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT library)
  set_property(GLOBAL APPEND PROPERTY PCL_FFT_GROUND_COMPONENTS ${name})
endfunction()

# pcl_fft_ground_program(<target>): a program that users run: in bin/ of the build tree; where it is installed it finds
# the libraries beside it, after the prefix has been moved, too.
function(pcl_fft_ground_program target)
  file(RELATIVE_PATH libraries_from_programs "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(${target} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin"
    INSTALL_RPATH "$ORIGIN/${libraries_from_programs}")
endfunction()
