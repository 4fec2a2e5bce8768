# Target `documentation`: the guide pages and the reference of all public headers, as HTML in documentation/ of the
# build tree.
find_package(Doxygen 1.9 REQUIRED)
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/documentation")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/README.md")
set(DOXYGEN_IMAGE_PATH "${PROJECT_SOURCE_DIR}/examples/guide")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_STRIP_FROM_INC_PATH "${PROJECT_SOURCE_DIR}/include")
set(DOXYGEN_FILE_PATTERNS *.h *.md)
set(DOXYGEN_EXCLUDE_PATTERNS "*/impl/*")
set(DOXYGEN_HTML_EXTRA_STYLESHEET "${PROJECT_SOURCE_DIR}/cmake/documentation.css")
set(DOXYGEN_GENERATE_TREEVIEW YES)
set(DOXYGEN_USE_MATHJAX YES)
# The formulas of one page; where MathJax is installed (libjs-mathjax) the pages need no network.
if(EXISTS /usr/share/javascript/mathjax/MathJax.js)
  set(DOXYGEN_MATHJAX_RELPATH file:///usr/share/javascript/mathjax)
endif()
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO) # what a name tells is not told again
if(PCL_FFT_GROUND_WERROR)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
endif()
# The command's own words are a page, where the command is built.
set(command_reference "")
if(TARGET pcl_fft_ground_help)
  set(command_reference "${PROJECT_BINARY_DIR}/help/commands.md")
endif()
doxygen_add_docs(documentation README.md CHANGELOG.md include examples/guide test/filters/FILTER_CONTRACT.md
                 ${command_reference} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
if(TARGET pcl_fft_ground_help)
  add_dependencies(documentation pcl_fft_ground_help)
endif()
