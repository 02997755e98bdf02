# Text files as constants of a library.
#   cordon_embed_files(target NAMESPACE name HEADER header FILES name=file...)
#     Defines `const Asset NAME = {text, sha256}` for each file, as `header` declares it; made anew
#     when a file changes.
#   cmake -DOUTPUT=… -DNAMESPACE=… -DHEADER=… -DFILES=… -P EmbedFiles.cmake does the work during the
#   build.
if(CMAKE_SCRIPT_MODE_FILE)
  set(source
    "// Made from files by cmake/EmbedFiles.cmake.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
  foreach(entry IN LISTS FILES)
    string(REGEX MATCH "^([^=]+)=(.*)$" matched "${entry}")
    set(name "${CMAKE_MATCH_1}")
    set(file "${CMAKE_MATCH_2}")
    file(READ "${file}" text)
    file(SHA256 "${file}" sha256)
    string(FIND "${text}" ")embedded\"" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} holds the mark that ends an embedded text: )embedded\"")
    endif()
    string(APPEND source "const Asset ${name} = {R\"embedded(${text})embedded\", \"${sha256}\"};\n")
  endforeach()
  file(WRITE "${OUTPUT}" "${source}}  // namespace ${NAMESPACE}\n")
  return()
endif()

set(CORDON_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")
function(cordon_embed_files target)
  cmake_parse_arguments(arg "" "NAMESPACE;HEADER" "FILES" ${ARGN})
  set(output "${CMAKE_CURRENT_BINARY_DIR}/embedded/${target}_assets.cpp")
  list(TRANSFORM arg_FILES REPLACE "^[^=]+=" "" OUTPUT_VARIABLE files)
  add_custom_command(OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${output}" "-DNAMESPACE=${arg_NAMESPACE}" "-DHEADER=${arg_HEADER}" "-DFILES=${arg_FILES}" -P "${CORDON_EMBED_SCRIPT}"
    DEPENDS ${files} "${CORDON_EMBED_SCRIPT}" COMMENT "Embedding the parts of the report" VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()
