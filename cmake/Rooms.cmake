# A room of the framework is a folder with its own library.
#   include/cordon/…  headers for everybody, installed
#   internal/…        headers for the rooms that may see this one, and for tests
#   src/              everything else; no other room can include it
#
# cordon_room(path [KERNELS] [SEES room...] [LIBRARIES target...])
#   Objects of the sources in the current folder's src/, as target cordon_room_PATH with "/" as "_",
#   e.g. study/text. They can include their own headers, and the headers of the rooms that they see;
#   those of rooms below these are named as well. KERNELS: optimised for speed; other rooms are
#   compiled more often than they compute.
#
# cordon_unity(target [FILES most] [ALONE file...])
#   Compiles several files of a target as one source, which takes less than half the time: headers
#   are read and templates compiled once. Three times as many to a unit as eight take a fifth less. Two files of a unit that define one name in their unnamed
#   namespaces do not compile: the name gets more precise, or a file is compiled alone.
#
# cordon_headers_of(name)
#   The headers alone, as target cordon_see_NAME; cordon_room calls it.
set_property(GLOBAL PROPERTY CORDON_INTERNAL_FOLDERS "")

function(cordon_headers_of path)
  string(REPLACE "/" "_" name "${path}")
  add_library(cordon_see_${name} INTERFACE)
  foreach(folder include internal)
    if(IS_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/${folder}")
      target_include_directories(cordon_see_${name} INTERFACE
        "${CMAKE_CURRENT_SOURCE_DIR}/${folder}")
    endif()
  endforeach()
  if(IS_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/internal")
    set_property(GLOBAL APPEND PROPERTY CORDON_INTERNAL_FOLDERS
      "${CMAKE_CURRENT_SOURCE_DIR}/internal")
  endif()
endfunction()

function(cordon_room path)
  cmake_parse_arguments(arg "KERNELS" "" "SEES;LIBRARIES;ALONE" ${ARGN})
  cordon_headers_of(${path})
  string(REPLACE "/" "_" name "${path}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/*.cpp)
  add_library(cordon_room_${name} OBJECT ${sources})
  target_include_directories(cordon_room_${name} PRIVATE src)
  list(TRANSFORM arg_SEES REPLACE "/" "_")
  list(TRANSFORM arg_SEES PREPEND cordon_see_)
  target_link_libraries(cordon_room_${name} PRIVATE cordon_see_${name} ${arg_SEES} Eigen3::Eigen
    ${arg_LIBRARIES})
  if(NOT arg_KERNELS)
    target_compile_options(cordon_room_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  cordon_unity(cordon_room_${name} ALONE ${arg_ALONE})
endfunction()

function(cordon_unity target)
  cmake_parse_arguments(arg "" "FILES" "ALONE" ${ARGN})
  if(NOT arg_FILES)
    set(arg_FILES 24)
  endif()
  get_target_property(sources ${target} SOURCES)
  list(LENGTH sources count)
  math(EXPR units "(${count} + ${arg_FILES} - 1) / ${arg_FILES}")  # all of about one size
  math(EXPR size "(${count} + ${units} - 1) / ${units}")
  set_target_properties(${target} PROPERTIES UNITY_BUILD "${CORDON_UNITY}"
    UNITY_BUILD_BATCH_SIZE ${size})
  foreach(file IN LISTS arg_ALONE)
    set_source_files_properties("${CMAKE_CURRENT_SOURCE_DIR}/${file}" PROPERTIES
      SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()

# cordon_sees(target room...)
#   The installed headers of rooms, for a library that may see no others of the framework.
function(cordon_sees target)
  foreach(room IN LISTS ARGN)
    target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/framework/${room}/include")
  endforeach()
  target_include_directories(${target} SYSTEM PRIVATE
    $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
endfunction()
