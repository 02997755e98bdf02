# Several files of tests as one source: headers that they share are read once, and templates
# compiled once. Each file is in a namespace of its own there, so that what it defines is its own.
#   cmake -DOUTPUT=… "-DSOURCES=a.cpp;b.cpp" -P TestUnits.cmake   writes it, during the build
set(includes "")
set(bodies "")
foreach(source IN LISTS SOURCES)
  file(STRINGS "${source}" lines REGEX "^#include ")
  list(APPEND includes ${lines})
  get_filename_component(name "${source}" NAME_WE)
  string(APPEND bodies
    "namespace file_${name} {\n#include \"${source}\"\n}  // namespace file_${name}\n")
endforeach()
list(REMOVE_DUPLICATES includes)
list(SORT includes)  # those in <> come last
list(JOIN includes "\n" includes)
file(WRITE "${OUTPUT}" "// Made by cmake/TestUnits.cmake.\n${includes}\n\n${bodies}")
