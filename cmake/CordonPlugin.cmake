# cordon_add_plugin(name SOURCES file... [LIBRARIES target...])
#   A plugin: a module that exports one symbol, its descriptor, and goes to the plugin directory of the build.
set(CORDON_PLUGIN_VERSION_SCRIPT "${CMAKE_CURRENT_LIST_DIR}/plugin.map")
function(cordon_add_plugin name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name}_plugin MODULE ${arg_SOURCES})
  target_link_libraries(${name}_plugin PRIVATE cordon::cordon ${arg_LIBRARIES})
  # -fno-gnu-unique: a unique symbol would keep the library mapped for ever and hide lifetime defects.
  target_compile_options(${name}_plugin PRIVATE -fno-gnu-unique)
  set_target_properties(${name}_plugin PROPERTIES
    OUTPUT_NAME ${name} PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib/cordon/plugins-v1"
    LINK_DEPENDS "${CORDON_PLUGIN_VERSION_SCRIPT}")
  target_link_options(${name}_plugin PRIVATE "-Wl,--version-script=${CORDON_PLUGIN_VERSION_SCRIPT}")
  if(NOT CORDON_SANITIZE)
    target_link_options(${name}_plugin PRIVATE -Wl,--no-undefined)
  endif()
endfunction()
