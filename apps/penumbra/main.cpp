// SPDX-License-Identifier: Apache-2.0
#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/help.hpp>

int main(int argc, char** argv) {
  using namespace penumbra::app;
  constexpr Command commands[] = {
      {"init", "write the recording.yaml of a folder of images", add_init},
      {"run", "label every frame of a recording or bag", add_run},
      {"cloud", "take the robot out of point clouds and laser scans", add_cloud},
      {"tune", "measure the sensor: tolerance, fringe, missing parts of the URDF", add_tune},
      {"calibrate", "find the camera's pose from the robot that it sees", add_calibrate},
      {"render", "render one virtual depth image", add_render},
      {"inspect", "list which links of a URDF are drawn", add_inspect},
      {"doctor", "print what this machine offers", add_doctor},
      {"simulate", "record a simulated scene with its truth", add_simulate},
      {"topics", "list the live topics of ROS 2's graph", add_topics},
      {"play", "publish a bag on ROS 2's graph", add_play},
      {"live", "label live topics of ROS 2 and publish the results", add_live},
      {"view", "show a recording or bag in the browser: 3-D, images, timeline", add_view},
      {"view-planning", "find where cameras see targets while the robot moves", add_view_planning},
      {"look-ahead", "say what a planned motion will hide, when, and by which link",
       add_look_ahead}};
  return run_program(argc, argv, commands, main_examples);
}
