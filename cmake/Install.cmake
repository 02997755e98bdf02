# `cmake --install`: the program, the libraries, their headers, and a CMake package for authors of
# plugins. Plugins install themselves.
include(CMakePackageConfigHelpers)
set(CORDON_PACKAGE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/cordon")

# The program finds its library wherever the tree is moved to.
file(RELATIVE_PATH libraries_from_programs "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
set_target_properties(cordon_app PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries_from_programs}")

set_target_properties(cordon_sdp cordon_study cordon_experiments cordon_c PROPERTIES INSTALL_RPATH "$ORIGIN")
file(RELATIVE_PATH libraries_from_plugins "/${CORDON_PLUGIN_DESTINATION}"
  "/${CMAKE_INSTALL_LIBDIR}")
set_target_properties(estimators_plugin PROPERTIES INSTALL_RPATH
  "$ORIGIN/${libraries_from_plugins}")

set_target_properties(cordon_app PROPERTIES EXPORT_NAME app)
foreach(name sets sdp study experiments c)
  set_target_properties(cordon_${name} PROPERTIES EXPORT_NAME ${name})
endforeach()
set_target_properties(cordon_invariant PROPERTIES EXPORT_NAME invariant)
install(TARGETS cordon cordon_sdp cordon_study cordon_experiments cordon_c cordon_sets cordon_invariant
  cordon_app EXPORT cordon
  RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
foreach(room core formulas solvers sdp interfaces linearisation tubes registry values study experiments)
  list(APPEND headers "${PROJECT_SOURCE_DIR}/framework/${room}/include/cordon")
endforeach()
install(DIRECTORY ${headers} "${PROJECT_BINARY_DIR}/framework/registry/include/cordon"
  "${PROJECT_SOURCE_DIR}/sets/include/cordon"
  "${PROJECT_SOURCE_DIR}/estimators/invariant/include/cordon" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")

# For C: one header, and what pkg-config tells of it.
install(FILES "${PROJECT_SOURCE_DIR}/framework/c/include/cordon.h" DESTINATION
  "${CMAKE_INSTALL_INCLUDEDIR}")
file(RELATIVE_PATH CORDON_PREFIX_FROM_PKGCONFIG "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file("${PROJECT_SOURCE_DIR}/framework/c/cordon_c.pc.in"
  "${PROJECT_BINARY_DIR}/package/cordon_c.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/package/cordon_c.pc" DESTINATION
  "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

if(TARGET cordon_conformance)
  set_target_properties(cordon_conformance PROPERTIES EXPORT_NAME conformance)
  install(TARGETS cordon_conformance EXPORT cordon ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/framework/conformance/include/cordon" DESTINATION
    "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")
endif()

install(EXPORT cordon FILE cordonTargets.cmake NAMESPACE cordon:: DESTINATION
  "${CORDON_PACKAGE_DESTINATION}")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/cordonConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/package/cordonConfig.cmake"
  INSTALL_DESTINATION "${CORDON_PACKAGE_DESTINATION}" NO_SET_AND_CHECK_MACRO)
# Before 1.0 every minor version may change the interfaces.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/package/cordonConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/package/cordonConfig.cmake"
  "${PROJECT_BINARY_DIR}/package/cordonConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/CordonPlugin.cmake" "${PROJECT_SOURCE_DIR}/cmake/plugin.map" DESTINATION "${CORDON_PACKAGE_DESTINATION}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
