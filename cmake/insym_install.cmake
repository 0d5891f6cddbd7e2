# cmake --install: library, headers, program and the package files for find_package(insym).
include(CMakePackageConfigHelpers)

install(TARGETS insym EXPORT insym-core)
install(DIRECTORY include/insym ${CMAKE_CURRENT_BINARY_DIR}/include/insym
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(EXPORT insym-core NAMESPACE insym:: FILE insym-core.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/insym)
foreach(component brep mesh view)
  if(TARGET insym_${component})
    install(TARGETS insym_${component} EXPORT insym-${component})
    install(EXPORT insym-${component} NAMESPACE insym:: FILE insym-${component}.cmake
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/insym)
  endif()
endforeach()
if(INSYM_BUILD_APP)
  install(TARGETS insym_app)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/insym-config.cmake.in insym-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/insym)
write_basic_package_version_file(insym-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/insym-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/insym-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/insym)
