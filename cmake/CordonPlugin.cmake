# cordon_add_plugin(name SOURCES file... [LIBRARIES target...] [DIRECTORY dir])
#   A plugin: a module that exports one symbol, its descriptor. It goes to the plugin directory of the build and is installed with
#   `cmake --install`; with DIRECTORY it goes there instead and is not installed.
include(GNUInstallDirs)
set(CORDON_PLUGIN_VERSION_SCRIPT "${CMAKE_CURRENT_LIST_DIR}/plugin.map")
function(cordon_add_plugin name)
  cmake_parse_arguments(arg "" "DIRECTORY" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT arg_SOURCES OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "cordon_add_plugin(${name}): needs SOURCES, takes LIBRARIES and DIRECTORY besides")
  endif()
  add_library(${name}_plugin MODULE ${arg_SOURCES})
  target_link_libraries(${name}_plugin PRIVATE cordon::cordon ${arg_LIBRARIES})
  # -fno-gnu-unique: a unique symbol would keep the library mapped for ever and hide lifetime defects (clang makes none).
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
  if(NOT arg_DIRECTORY)
    install(TARGETS ${name}_plugin DESTINATION "${CMAKE_INSTALL_LIBDIR}/cordon/plugins-v1")
  endif()
endfunction()
