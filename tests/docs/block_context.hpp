// SPDX-License-Identifier: Apache-2.0
// Declarations that the code blocks of the documents use.
#pragma once

#include <penumbra/camera/registration.hpp>
#include <penumbra/fusion/target_fusion.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/session/session.hpp>
#include <penumbra/time/pose_history.hpp>
#include <penumbra/tracking/trackers.hpp>

struct Arm {
  void wait();
};

extern Arm arm;
extern penumbra::Robot robot;
extern penumbra::Pipeline pipeline, left, right;
extern penumbra::Camera camera, depth_camera, colour_camera;
extern penumbra::Frame frame, left_frame, right_frame;
extern penumbra::DepthView depth;
extern penumbra::Verdict verdict;
extern Eigen::Isometry3d T_parent_child, T_colour_depth, T_base_object;
extern std::vector<std::string> names;
extern std::vector<double> positions, configurations;
extern std::vector<penumbra::TrajectoryPoint> points;
extern std::vector<penumbra::ForecastTarget> targets;
extern std::string parent, child;
extern std::int64_t stamp, now, image_stamp, clock_now;
extern std::shared_ptr<const void> owner;
