# SPDX-License-Identifier: Apache-2.0
# `cmake --install` and find_package(Penumbra) with the target Penumbra::penumbra.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Penumbra)

install(TARGETS penumbra EXPORT PenumbraTargets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/penumbra DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*-inl.hpp" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/penumbra/base/version.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra/base)
install(EXPORT PenumbraTargets NAMESPACE Penumbra:: DESTINATION ${package_dir})

get_target_property(library_type penumbra TYPE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/PenumbraConfig.cmake.in
  ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake
              ${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
