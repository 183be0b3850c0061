# SPDX-License-Identifier: Apache-2.0
# `cmake --install` and find_package(Penumbra [COMPONENTS ...]). Each library is a component.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Penumbra)

foreach(name penumbra cloud diagnosis setup planning session io live)
  set(library penumbra_${name})
  if(name STREQUAL penumbra)
    set(library penumbra)
  endif()
  if(TARGET ${library})
    install(TARGETS ${library} EXPORT Penumbra_${name}
      RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${name}
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name})
    install(EXPORT Penumbra_${name} NAMESPACE Penumbra:: DESTINATION ${package_dir} COMPONENT ${name})
  endif()
endforeach()

# The public headers: the classes that docs/cpp.md names, and what these include. All other headers
# are free to change.
set(public_headers
  base/error.hpp base/image.hpp base/setting.hpp
  mesh/prepared_mesh.hpp robot/robot.hpp robot/trajectory.hpp
  time/joint_buffer.hpp time/pose_history.hpp time/transform_buffer.hpp
  camera/camera.hpp camera/rectification.hpp camera/registration.hpp
  render/depth_renderer.hpp labels/labels.hpp poses/robot_pose.hpp
  tracking/trackers.hpp targets/target.hpp targets/target_judge.hpp
  cloud/scan.hpp
  pipeline/frame.hpp pipeline/frame_queue.hpp pipeline/link_points.hpp pipeline/pipeline.hpp pipeline/without_robot.hpp
  calibration/calibration.hpp calibration/kept_frames.hpp diagnosis/diagnosis.hpp
  planning/look_ahead.hpp planning/view_planning.hpp fusion/target_fusion.hpp
  session/session.hpp)
set(component_of_calibration diagnosis)
set(component_of_diagnosis diagnosis)
set(component_of_planning planning)
set(component_of_fusion planning)
set(component_of_session session)
foreach(header IN LISTS public_headers)
  get_filename_component(room ${header} DIRECTORY)
  set(component penumbra)
  if(component_of_${room})
    set(component ${component_of_${room}})
  endif()
  install(FILES ${PROJECT_SOURCE_DIR}/penumbra/${header}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra/${room} COMPONENT ${component})
endforeach()
# Of io, recordings and their frames are for users (io/files/recording.hpp and frame_reader.hpp). The
# other headers may change at any time: ros/penumbra_ros is built with them.
if(TARGET penumbra_io)
  foreach(room files ros cloud mcap bag assembly live)
    set(component io)
    if(room STREQUAL live)
      set(component live)
    endif()
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/io/${room}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra_io/io COMPONENT ${component}
      FILES_MATCHING PATTERN "*.hpp" PATTERN "*-inl.hpp" EXCLUDE
      PATTERN "tuning_report.hpp" EXCLUDE PATTERN "json.hpp" EXCLUDE)
  endforeach()
endif()

# An archive is linked together with the packages that it uses itself.
get_target_property(library_type penumbra TYPE)
set(static OFF)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(static ON)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/PenumbraConfig.cmake.in
  ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/PenumbraConfig.cmake
              ${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT penumbra)
install(FILES ${PROJECT_BINARY_DIR}/generated/penumbra/base/version.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/penumbra/base COMPONENT penumbra)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT penumbra)
