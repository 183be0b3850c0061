# SPDX-License-Identifier: Apache-2.0
# `cmake --install` and find_package(Penumbra) with the target Penumbra::penumbra.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Penumbra)

set(libraries penumbra)
if(TARGET penumbra_live AND PENUMBRA_INSTALL_LIVE)
  # Penumbra::live is for ros/penumbra_ros alone: its headers may change at any time.
  list(APPEND libraries penumbra_live)
  foreach(room files ros cloud mcap bag assembly live)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/io/${room}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra_live/io
      FILES_MATCHING PATTERN "*.hpp" PATTERN "*-inl.hpp" EXCLUDE
      PATTERN "tuning_report.hpp" EXCLUDE)
  endforeach()
endif()
install(TARGETS ${libraries} EXPORT PenumbraTargets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
# The public headers: the classes that docs/cpp.md names, and what these include. All other headers
# are free to change.
set(public_headers
  base/error.hpp base/image.hpp base/setting.hpp base/stamps.hpp
  mesh/prepared_mesh.hpp mesh/triangle_mesh.hpp robot/robot.hpp
  time/attachments.hpp time/joint_buffer.hpp time/pose_history.hpp time/source_tracks.hpp
  time/stamped_track.hpp time/transform_buffer.hpp
  camera/camera.hpp camera/distortion.hpp camera/intrinsics.hpp camera/rectification.hpp
  camera/registration.hpp
  render/depth_renderer.hpp render/pixel_rectangle.hpp
  labels/labels.hpp poses/pose_lookup.hpp poses/robot_pose.hpp tracking/trackers.hpp
  targets/region.hpp targets/target.hpp targets/target_judge.hpp
  pipeline/frame.hpp pipeline/frame_queue.hpp pipeline/pipeline.hpp pipeline/without_robot.hpp
  calibration/calibration.hpp calibration/watch.hpp diagnosis/diagnosis.hpp
  session/plan_forecast.hpp session/session.hpp session/warnings.hpp tuning/missing_parts.hpp
  scene/look_ahead.hpp scene/target_fusion.hpp robot/trajectory.hpp scene/view_planning.hpp
  cloud/cloud_labels.hpp
  cloud/cloud_pipeline.hpp
  cloud/cloud_tuning.hpp)
foreach(header IN LISTS public_headers)
  get_filename_component(room ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/penumbra/${header}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra/${room})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/penumbra/base/version.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra/base)
install(EXPORT PenumbraTargets NAMESPACE Penumbra:: DESTINATION ${package_dir})

# An archive is linked together with the libraries that it uses itself: NAME::TARGET comes from the
# package NAME.
set(private_packages)
get_target_property(library_type penumbra TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  get_target_property(private_packages penumbra LINK_LIBRARIES)
  list(FILTER private_packages INCLUDE REGEX "^[A-Za-z0-9_-]+::")
  list(TRANSFORM private_packages REPLACE "::.*" "")
  list(REMOVE_DUPLICATES private_packages)
  list(REMOVE_ITEM private_packages Eigen3)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/PenumbraConfig.cmake.in
  ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake
              ${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
