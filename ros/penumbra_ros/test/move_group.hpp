// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <moveit_msgs/srv/get_planning_scene.hpp>
#include <rclcpp/rclcpp.hpp>

namespace penumbra_ros::test {

/// Answers as MoveIt does, with a box on the arm's gripper or with nothing.
class MoveIt {
 public:
  explicit MoveIt(bool with_box) : node(std::make_shared<rclcpp::Node>("move_group")) {
    using moveit_msgs::srv::GetPlanningScene;
    scenes_ =
        node->create_publisher<moveit_msgs::msg::PlanningScene>("monitored_planning_scene", 10);
    service_ = node->create_service<GetPlanningScene>(
        "get_planning_scene",
        [this, with_box](const std::shared_ptr<rclcpp::Service<GetPlanningScene>> service,
                         const std::shared_ptr<rmw_request_id_t> id,
                         const GetPlanningScene::Request::SharedPtr /*request*/) {
          if (++asked <= lost) return;
          if (is_busy) scenes_->publish(moveit_msgs::msg::PlanningScene());
          GetPlanningScene::Response answer;
          auto& state = answer.scene.robot_state;
          state.joint_state.name = {"shoulder_pan"};
          state.joint_state.position = {0.0};
          if (with_box) state.attached_collision_objects = {box()};
          service->send_response(*id, answer);
        });
  }

  rclcpp::Node::SharedPtr node;
  int asked = 0;
  int lost = 0;          ///< the first requests that it does not answer
  bool is_busy = false;  ///< publishes a scene before it answers

 private:
  static moveit_msgs::msg::AttachedCollisionObject box() {
    moveit_msgs::msg::AttachedCollisionObject box;
    box.link_name = "gripper";
    box.object.id = "box";
    box.object.header.frame_id = "gripper";
    box.object.primitives.resize(1);
    box.object.primitives[0].type = shape_msgs::msg::SolidPrimitive::BOX;
    box.object.primitives[0].dimensions = {0.3, 0.3, 0.3};
    box.object.primitive_poses.resize(1);
    box.object.pose.orientation.w = box.object.primitive_poses[0].orientation.w = 1.0;
    return box;
  }

  rclcpp::Publisher<moveit_msgs::msg::PlanningScene>::SharedPtr scenes_;
  rclcpp::ServiceBase::SharedPtr service_;
};

}  // namespace penumbra_ros::test
