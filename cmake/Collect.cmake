# cordon_collect(MACRO FILES file...)
#   Finds the lines `MACRO(arguments) {`, each the head of a function, so that what a file adds to a
#   list stands in that file alone. Sets MACRO in the caller to the list of their arguments, in the
#   order of the files, and writes `MACRO(arguments)` for each into <current build
#   folder>/generated/MACRO.inc, to be included where MACRO means what is to be done with one.
#   Configured anew when one of the files changes, or comes or goes (where they are from a glob with
#   CONFIGURE_DEPENDS).
function(cordon_collect macro)
  cmake_parse_arguments(arg "" "" "FILES" ${ARGN})
  set(found "")
  set(text "")
  foreach(file IN LISTS arg_FILES)
    file(STRINGS "${file}" lines REGEX "^${macro}\\(.*\\) {$")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^${macro}\\((.*)\\) {$" "\\1" arguments "${line}")
      list(APPEND found "${arguments}")
      string(APPEND text "${macro}(${arguments})\n")
    endforeach()
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${arg_FILES})
  if(NOT found)
    message(FATAL_ERROR "cordon_collect: no file has a line ${macro}(…) {")
  endif()
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/generated/${macro}.inc" CONTENT "${text}")
  set(${macro} "${found}" PARENT_SCOPE)
endfunction()
