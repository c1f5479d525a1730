# Writes OUT, a C file that says which commit SOURCE is a checkout of, where that has changed:
#   cmake -D SOURCE=DIR -D OUT=commit.c -P commit.cmake
# "-dirty" follows where a file that git knows is not as committed. NULL: SOURCE is no checkout, or
# there is no git.
unset(ENV{GIT_DIR})
unset(ENV{GIT_WORK_TREE})
unset(ENV{GIT_INDEX_FILE})
find_program(GIT git)

# The last line that git has to say; "" where it fails.
function(git result)
  set(${result} "" PARENT_SCOPE)
  if(NOT GIT)
    return()
  endif()
  execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE} ${ARGN}
    RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(code EQUAL 0)
    set(${result} "${said}" PARENT_SCOPE)
  endif()
endfunction()

# The source may lie, unpacked, in a checkout of something else.
set(commit NULL)
git(top rev-parse --show-toplevel)
get_filename_component(source "${SOURCE}" REALPATH)
if(top AND "${top}" STREQUAL "${source}")
  git(head rev-parse --verify HEAD)
  if(head MATCHES "^[0-9a-f]+$")
    git(changes status --porcelain --untracked-files=no)
    if(changes)
      string(APPEND head -dirty)
    endif()
    set(commit "\"${head}\"")
  endif()
endif()

set(text "#include \"app/folder/provenance.h\"\n\nconst char *const provenance_commit = ${commit};\n")
set(before "")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
