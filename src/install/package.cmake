# Packages of Debian, by `cpack -G DEB` in a build that is installed to /usr:
#   cmake -B build/deb -DBUILD_SHARED_LIBS=ON -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON
#     -DCOROT_ZSH_DIR=share/zsh/vendor-completions -DCOROT_TESTS=OFF -DCOROT_PYTHON=OFF
# corot has the program, libcorotN the shared libraries, libcorot-dev what a host is compiled with. What
# they need is what dpkg-shlibdeps finds.
set(COROT_MAINTAINER "the corot developers <developers@corot.invalid>" CACHE STRING
  "Who is named in packages of Debian")
set(library_package libcorot${COROT_ABI})

set(CPACK_PACKAGE_NAME corot)
set(CPACK_PACKAGE_VENDOR "the corot developers")
set(CPACK_PACKAGE_CONTACT ${COROT_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "deformable solids with error control")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(BUILD_SHARED_LIBS)
  list(APPEND CPACK_COMPONENTS_ALL library)
endif()

set(text "corot discretises elastic bodies by tetrahedra in the corotational formulation, and\n"
  "integrates them with error control, by SUNDIALS.")
string(JOIN "" text ${text})
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${text}\nThis is the program.")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${text}\nThese are the shared libraries.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "${text}\nThese are headers, and files for CMake and pkg-config.")

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME corot)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcorot-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(development libsundials-dev libsuitesparse-dev)
if(COROT_WITH_METIS)
  list(APPEND development libmetis-dev)
endif()
if(COROT_WITH_ARPACK)
  list(APPEND development libarpack2-dev)
endif()
if(BUILD_SHARED_LIBS)
  list(PREPEND development "${library_package} (= ${PROJECT_VERSION})")
endif()
list(JOIN development ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ${BUILD_SHARED_LIBS})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  ${PROJECT_BINARY_DIR}/src/core ${PROJECT_BINARY_DIR}/src/solve)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

# Of packages alone: where Debian wants licence and changes.
foreach(pair program:corot library:${library_package} development:libcorot-dev)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${doc} RENAME copyright
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${doc}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
