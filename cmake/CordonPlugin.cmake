# cordon_add_plugin(name SOURCES file... [LIBRARIES target...] [PROVIDES "kind component"...]
# [CONFORMANCE component...] [DIRECTORY dir])
#   A plugin: a module that exports one symbol, its descriptor. Serves Cordon itself and, after
#   find_package(cordon), everybody else. It is built into <build>/lib/cordon/plugins-v1 and
#   installed with `cmake --install`; with DIRECTORY it is built there and not installed.
#   PROVIDES announces its components in a text file beside it, so that a missing or damaged library
#   is named where one is needed.
#   CONFORMANCE adds a test per component that runs `cordon conform` on it (ctest -R conform).
include(GNUInstallDirs)
set(CORDON_PLUGIN_VERSION_SCRIPT "${CMAKE_CURRENT_LIST_DIR}/plugin.map")
if(NOT CORDON_PLUGIN_DESTINATION)
  set(CORDON_PLUGIN_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cordon/plugins-v1")
endif()
macro(cordon_add_plugin name)  # a macro, because testing is enabled in the scope of the caller only
  if(";${ARGN};" MATCHES ";CONFORMANCE;")
    enable_testing()
  endif()
  cordon_add_plugin_targets(${name} ${ARGN})
endmacro()
function(cordon_add_plugin_targets name)
  cmake_parse_arguments(arg "" "DIRECTORY" "SOURCES;LIBRARIES;PROVIDES;CONFORMANCE" ${ARGN})
  if(NOT arg_SOURCES OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR
      "cordon_add_plugin(${name}): needs SOURCES, takes LIBRARIES, PROVIDES, CONFORMANCE and DIRECTORY besides")
  endif()
  # Known where Cordon was installed. What another compiler makes has another ABI tag, and is
  # refused when it is loaded.
  if(CORDON_COMPILER AND NOT CORDON_COMPILER MATCHES "^${CMAKE_CXX_COMPILER_ID} ")
    message(FATAL_ERROR
      "cordon_add_plugin(${name}): this Cordon was compiled by ${CORDON_COMPILER} and refuses plugins that "
      "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} has compiled. Configure a new build directory with the same compiler "
      "(-DCMAKE_CXX_COMPILER=...), or build Cordon with this one.")
  endif()
  add_library(${name}_plugin MODULE ${arg_SOURCES})
  target_link_libraries(${name}_plugin PRIVATE cordon::cordon ${arg_LIBRARIES})
  # -fno-gnu-unique: a unique symbol would keep the library mapped for ever and hide lifetime
  # defects (clang makes none).
  target_compile_options(${name}_plugin PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  set(directory "${PROJECT_BINARY_DIR}/lib/cordon/plugins-v1")
  if(arg_DIRECTORY)
    set(directory "${arg_DIRECTORY}")
  endif()
  set_target_properties(${name}_plugin PROPERTIES
    OUTPUT_NAME ${name} PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY "${directory}" LINK_DEPENDS "${CORDON_PLUGIN_VERSION_SCRIPT}")
  target_link_options(${name}_plugin PRIVATE "-Wl,--version-script=${CORDON_PLUGIN_VERSION_SCRIPT}")
  if(NOT CORDON_SANITIZE)
    target_link_options(${name}_plugin PRIVATE -Wl,--no-undefined)
  endif()
  if(arg_PROVIDES)
    list(JOIN arg_PROVIDES "\n" announced)
    file(GENERATE OUTPUT "${directory}/${name}.provides" CONTENT "${announced}\n")
    if(NOT arg_DIRECTORY)
      install(FILES "${directory}/${name}.provides" DESTINATION "${CORDON_PLUGIN_DESTINATION}")
    endif()
  endif()
  if(NOT arg_DIRECTORY)
    install(TARGETS ${name}_plugin DESTINATION "${CORDON_PLUGIN_DESTINATION}")
  endif()
  foreach(component IN LISTS arg_CONFORMANCE)
    add_test(NAME conform_${name}_${component} COMMAND $<TARGET_FILE:cordon::app> conform
      "$<TARGET_FILE:${name}_plugin>" --component ${component})
    set_tests_properties(conform_${name}_${component} PROPERTIES LABELS conformance)
  endforeach()
endfunction()
