# Target `documentation`: the guide pages and the reference of all public headers, as HTML in documentation/ of the
# build tree.
find_package(Doxygen 1.9 REQUIRED)
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/documentation")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/README.md")
set(DOXYGEN_IMAGE_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_STRIP_FROM_INC_PATH "${PROJECT_SOURCE_DIR}/include")
set(DOXYGEN_FILE_PATTERNS *.h *.md)
set(DOXYGEN_EXCLUDE_PATTERNS "*/impl/*")
set(DOXYGEN_USE_MATHJAX YES)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
if(PCL_FFT_GROUND_WERROR)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
endif()
doxygen_add_docs(documentation README.md CHANGELOG.md include examples/guide test/filters/FILTER_CONTRACT.md
                 WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
