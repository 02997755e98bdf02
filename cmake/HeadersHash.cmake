# A hash of what plugins are compiled with. The ABI tag holds it: a plugin that was built against
# other headers is refused instead of crashing. Comments and blanks do not count, they change no
# layout.
#   cordon_headers_hash(variable header...)
#   cmake "-DHEADERS=a.hpp;b.hpp" -P HeadersHash.cmake   prints it
function(cordon_headers_hash variable)
  set(digest "")
  foreach(header IN LISTS ARGN)
    file(READ "${header}" text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX REPLACE "[ \t\r\n]+" " " text "${text}")
    string(SHA256 one "${text}")
    get_filename_component(name "${header}" NAME)
    string(APPEND digest "${name} ${one}\n")
  endforeach()
  string(SHA256 digest "${digest}")
  string(SUBSTRING "${digest}" 0 16 digest)
  set(${variable} "${digest}" PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  cordon_headers_hash(digest ${HEADERS})
  message("${digest}")
endif()
