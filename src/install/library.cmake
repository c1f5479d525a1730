# The libraries that hosts link, static or shared as BUILD_SHARED_LIBS says. The target corot_NAME is
# an archive in either case: our own program and tests, which look into it, link that. What stands for
# corot::NAME in a shared build is corot_NAME_shared, of the same objects.
#
# A shared library exports what is marked COROT_API in the public headers, under the version
# COROT_MAJOR.MINOR; and to its sisters what is marked COROT_SISTERS, under a version that only the
# same release has, so that libraries of different builds refuse each other when they are loaded.
include(CheckCCompilerFlag)
include(CheckLinkerFlag)

# While MAJOR is 0, a MINOR may change anything.
set(COROT_ABI ${PROJECT_VERSION_MAJOR})
if(COROT_ABI EQUAL 0)
  set(COROT_ABI ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endif()

# A flag: a target named m, or a path of this machine, is not what is meant.
find_library(COROT_MATH m)
mark_as_advanced(COROT_MATH)

if(BUILD_SHARED_LIBS)
  # A call from one function of a library to another of the same goes there directly.
  check_c_compiler_flag(-fno-semantic-interposition COROT_HAVE_NO_INTERPOSITION)
  target_compile_definitions(corot_options INTERFACE COROT_EXPORTS)
  target_compile_options(corot_options INTERFACE
    $<$<BOOL:${COROT_HAVE_NO_INTERPOSITION}>:-fno-semantic-interposition>)
  foreach(flag z,defs Bsymbolic-functions -undefined-version)
    string(MAKE_C_IDENTIFIER "COROT_LINKER_${flag}" has)
    check_linker_flag(C LINKER:-${flag} ${has})
    if(${has})
      list(APPEND COROT_SHARED_OPTIONS LINKER:-${flag})
    endif()
  endforeach()
  if(CMAKE_C_FLAGS MATCHES fsanitize)
    list(REMOVE_ITEM COROT_SHARED_OPTIONS LINKER:-z,defs)  # the program has the sanitizer's functions
  endif()

  # The version script.
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/src/core/*.h ${PROJECT_SOURCE_DIR}/src/solve/*.h)
  set(sisters)
  foreach(header ${headers})
    file(READ ${header} text)
    string(REGEX MATCHALL "COROT_SISTERS [^(;[]*corot_[a-z0-9_]+" marked "${text}")
    list(TRANSFORM marked REPLACE ".*(corot_[a-z0-9_]+)$" "\\1")
    list(APPEND sisters ${marked})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  endforeach()
  list(SORT sisters)
  list(JOIN sisters "; " sisters)
  set(COROT_MAP ${PROJECT_BINARY_DIR}/corot.map)
  file(WRITE ${COROT_MAP}.new "COROT_${COROT_ABI} { global: corot_*; local: *; };\n"
    "COROT_PRIVATE_${PROJECT_VERSION} { global: ${sisters}; };\n")
  configure_file(${COROT_MAP}.new ${COROT_MAP} COPYONLY)
  check_linker_flag(C LINKER:--version-script=${COROT_MAP} COROT_LINKER_VERSION_SCRIPT)
endif()

# corot_library(NAME PUBLIC...): corot::NAME, of the objects of corot_NAME, the object libraries in its
# property COROT_OBJECTS, and all that it links; PUBLIC is what a host that includes our headers uses too.
function(corot_library name)
  target_link_libraries(corot_${name} PUBLIC ${ARGN} PRIVATE $<$<BOOL:${COROT_MATH}>:-lm>)
  if(NOT BUILD_SHARED_LIBS)
    set_target_properties(corot_${name} PROPERTIES EXPORT_NAME ${name})
    add_library(corot::${name} ALIAS corot_${name})
    return()
  endif()

  get_target_property(more corot_${name} COROT_OBJECTS)
  set(objects $<TARGET_OBJECTS:corot_${name}>)
  if(more)
    list(APPEND objects ${more})
  endif()
  set(shared corot_${name}_shared)
  add_library(${shared} SHARED ${objects})
  add_library(corot::${name} ALIAS ${shared})
  set_target_properties(${shared} PROPERTIES OUTPUT_NAME corot_${name} EXPORT_NAME ${name}
    LINKER_LANGUAGE C VERSION ${PROJECT_VERSION} SOVERSION ${COROT_ABI})
  set_target_properties(corot_${name} PROPERTIES EXCLUDE_FROM_ALL ON)

  get_target_property(used corot_${name} LINK_LIBRARIES)
  list(REMOVE_ITEM used ${ARGN} $<BUILD_INTERFACE:corot_options>)
  list(TRANSFORM ARGN REPLACE "^(corot_.*)" "\\1_shared" OUTPUT_VARIABLE public)
  target_link_libraries(${shared} PUBLIC ${public} PRIVATE ${used})
  get_target_property(include corot_${name} INTERFACE_INCLUDE_DIRECTORIES)
  if(include)
    target_include_directories(${shared} INTERFACE ${include})
  endif()
  target_link_options(${shared} PRIVATE ${COROT_SHARED_OPTIONS})
  if(COROT_LINKER_VERSION_SCRIPT)
    target_link_options(${shared} PRIVATE LINKER:--version-script=${COROT_MAP})
    set_target_properties(${shared} PROPERTIES LINK_DEPENDS ${COROT_MAP})
  endif()
  if(NOT DEFINED CMAKE_INSTALL_RPATH)  # its sisters are beside it, wherever that is
    set_target_properties(${shared} PROPERTIES INSTALL_RPATH $ORIGIN)
  endif()
endfunction()
