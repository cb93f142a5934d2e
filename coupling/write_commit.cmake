# Writes the header FILE with the commit of the sources in FOLDER, or "" outside a repository; a "+"
# marks changed files. An unchanged header is left alone, so nothing is compiled again.
execute_process(COMMAND git rev-parse --short HEAD WORKING_DIRECTORY ${FOLDER}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit "")
else()
  execute_process(COMMAND git status --porcelain --untracked-files=no WORKING_DIRECTORY ${FOLDER}
                  OUTPUT_VARIABLE changed ERROR_QUIET)
  if(NOT changed STREQUAL "")
    string(APPEND commit "+")
  endif()
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#pragma once\n#define GRAINFIELD_COMMIT \"${commit}\"\n")
