# ARPACK with its C interface (ARPACK-NG 3.8 or newer, built with ICB) as target ARPACK::ARPACK.
# Installed with the package, which has to find the same library again.
find_path(ARPACK_INCLUDE_DIR arpack/arpack.h)
find_library(ARPACK_LIBRARY arpack)
mark_as_advanced(ARPACK_INCLUDE_DIR ARPACK_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ARPACK REQUIRED_VARS ARPACK_LIBRARY ARPACK_INCLUDE_DIR)
if(ARPACK_FOUND AND NOT TARGET ARPACK::ARPACK)
  add_library(ARPACK::ARPACK UNKNOWN IMPORTED)
  set_target_properties(ARPACK::ARPACK PROPERTIES
    IMPORTED_LOCATION ${ARPACK_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${ARPACK_INCLUDE_DIR})
endif()
