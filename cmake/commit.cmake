# Writes TO from FROM with the commit of the sources in ROOT, only when it changed: what does not change is not
# compiled again. Run at each build.
#   cmake -DROOT=<source dir> -DFROM=<template> -DTO=<header> -P commit.cmake
set(COPPICE_COMMIT unknown)
find_package(Git QUIET)
if(Git_FOUND AND EXISTS ${ROOT}/.git)  # not the repository of others in which an archive was unpacked
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --abbrev=40 --exclude=* --dirty=-modified
    WORKING_DIRECTORY ${ROOT} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(COPPICE_COMMIT ${commit})
  endif()
endif()
configure_file(${FROM} ${TO} @ONLY)
