# SuiteSparse as targets SuiteSparse::AMD, SuiteSparse::KLU and SuiteSparse::CHOLMOD, whichever are asked for as
# components. Installed with the package, which has to find the same libraries again.
find_path(SuiteSparse_INCLUDE_DIR suitesparse/klu.h)
mark_as_advanced(SuiteSparse_INCLUDE_DIR)
foreach(component IN LISTS SuiteSparse_FIND_COMPONENTS)
  string(TOLOWER ${component} name)
  find_library(SuiteSparse_${component}_LIBRARY ${name})
  mark_as_advanced(SuiteSparse_${component}_LIBRARY)
  if(SuiteSparse_${component}_LIBRARY)
    set(SuiteSparse_${component}_FOUND TRUE)
    if(NOT TARGET SuiteSparse::${component})
      add_library(SuiteSparse::${component} UNKNOWN IMPORTED)
      set_target_properties(SuiteSparse::${component} PROPERTIES
        IMPORTED_LOCATION ${SuiteSparse_${component}_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${SuiteSparse_INCLUDE_DIR})
    endif()
  endif()
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS SuiteSparse_INCLUDE_DIR
  HANDLE_COMPONENTS)
