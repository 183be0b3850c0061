// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <io/ros/messages.hpp>

namespace penumbra::io {

// MoveIt's messages, as messages.hpp has the others.

struct VertexMessage {
  static constexpr std::string_view ros_type = "geometry_msgs/Point";
  static auto layout(auto& m) { return fields_of(m.x, m.y, m.z); }

  double x = 0, y = 0, z = 0;
};

struct SolidPrimitiveMessage {
  static constexpr std::string_view ros_type = "shape_msgs/SolidPrimitive";
  static auto layout(auto& m) { return fields_of(m.type, m.dimensions, m.polygon); }

  struct Point32 {
    static constexpr std::string_view ros_type = "geometry_msgs/Point32";
    static auto layout(auto& m) { return fields_of(m.x, m.y, m.z); }

    float x = 0, y = 0, z = 0;
  };
  struct Polygon {
    static constexpr std::string_view ros_type = "geometry_msgs/Polygon";
    static auto layout(auto& m) { return fields_of(m.points); }

    std::vector<Point32> points = {};
  };
  enum Type : std::uint8_t { box = 1, sphere, cylinder, cone, prism };

  std::uint8_t type = 0;
  std::vector<double> dimensions = {};  ///< box: x, y, z; sphere: radius; cylinder: height, radius
  Polygon polygon = {};
};

struct MeshMessage {
  static constexpr std::string_view ros_type = "shape_msgs/Mesh";
  static auto layout(auto& m) { return fields_of(m.triangles, m.vertices); }

  struct Triangle {
    static constexpr std::string_view ros_type = "shape_msgs/MeshTriangle";
    static auto layout(auto& m) { return fields_of(m.vertices); }

    std::array<std::uint32_t, 3> vertices{};
  };
  std::vector<Triangle> triangles = {};
  std::vector<VertexMessage> vertices = {};
};

struct CollisionObjectMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/CollisionObject";
  static auto layout(auto& m) {
    return fields_of(m.header, m.pose, m.id, m.type, m.primitives, m.primitive_poses, m.meshes,
                     m.mesh_poses, m.planes, m.plane_poses, m.subframe_names, m.subframe_poses,
                     m.operation);
  }

  struct Type {
    static constexpr std::string_view ros_type = "object_recognition_msgs/ObjectType";
    static auto layout(auto& m) { return fields_of(m.key, m.db); }

    std::string key = {}, db = {};
  };
  struct Plane {
    static constexpr std::string_view ros_type = "shape_msgs/Plane";
    static auto layout(auto& m) { return fields_of(m.coefficients); }

    std::array<double, 4> coefficients{};
  };
  enum Operation : std::uint8_t { add, remove, append, move };

  MessageHeader header = {};
  LoosePose pose = {};  ///< of the object in the frame; shapes have poses in the object
  std::string id = {};
  Type type = {};
  std::vector<SolidPrimitiveMessage> primitives = {};
  std::vector<LoosePose> primitive_poses = {};
  std::vector<MeshMessage> meshes = {};
  std::vector<LoosePose> mesh_poses = {};
  std::vector<Plane> planes = {};
  std::vector<LoosePose> plane_poses = {};
  std::vector<std::string> subframe_names = {};
  std::vector<LoosePose> subframe_poses = {};
  std::uint8_t operation = add;
};

struct JointTrajectoryMessage {
  static constexpr std::string_view ros_type = "trajectory_msgs/JointTrajectory";
  static auto layout(auto& m) { return fields_of(m.header, m.joint_names, m.points); }

  struct Duration {
    static constexpr std::string_view ros_type = "builtin_interfaces/Duration";
    static auto layout(auto& m) { return fields_of(m.sec, m.nanosec); }

    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
  };
  struct Point {
    static constexpr std::string_view ros_type = "trajectory_msgs/JointTrajectoryPoint";
    static auto layout(auto& m) {
      return fields_of(m.positions, m.velocities, m.accelerations, m.effort, m.time_from_start);
    }

    std::vector<double> positions = {}, velocities = {}, accelerations = {}, effort = {};
    Duration time_from_start = {};
  };

  MessageHeader header = {};
  std::vector<std::string> joint_names = {};
  std::vector<Point> points = {};
};

/// MoveIt's message of an object that a link carries.
struct AttachedObjectMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/AttachedCollisionObject";
  static auto layout(auto& m) {
    return fields_of(m.link_name, m.object, m.touch_links, m.detach_posture, m.weight);
  }

  std::string link_name = {};
  CollisionObjectMessage object = {};
  std::vector<std::string> touch_links = {};
  JointTrajectoryMessage detach_posture = {};
  double weight = 0;
};

struct MultiDofJointStateMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/MultiDOFJointState";
  static auto layout(auto& m) {
    return fields_of(m.header, m.joint_names, m.transforms, m.twists, m.wrenches);
  }

  struct Vector {
    static constexpr std::string_view ros_type = "geometry_msgs/Vector3";
    static auto layout(auto& m) { return fields_of(m.x, m.y, m.z); }

    double x = 0, y = 0, z = 0;
  };
  struct Transform {
    static constexpr std::string_view ros_type = "geometry_msgs/Transform";
    static auto layout(auto& m) { return fields_of(m.translation, as<QuaternionWire>(m.rotation)); }

    Vector translation = {};
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  };
  struct Twist {
    static constexpr std::string_view ros_type = "geometry_msgs/Twist";
    static auto layout(auto& m) { return fields_of(m.linear, m.angular); }

    Vector linear = {}, angular = {};
  };
  struct Wrench {
    static constexpr std::string_view ros_type = "geometry_msgs/Wrench";
    static auto layout(auto& m) { return fields_of(m.force, m.torque); }

    Vector force = {}, torque = {};
  };

  MessageHeader header = {};
  std::vector<std::string> joint_names = {};
  std::vector<Transform> transforms = {};
  std::vector<Twist> twists = {};
  std::vector<Wrench> wrenches = {};
};

struct RobotStateMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/RobotState";
  static auto layout(auto& m) { return fields_of(m.joints, m.other_joints, m.attached, m.is_diff); }

  JointStateMessage joints = {};
  MultiDofJointStateMessage other_joints = {};
  std::vector<AttachedObjectMessage> attached = {};
  bool is_diff = false;
};

/// MoveIt's message of a planned motion, whose parts follow one another.
struct DisplayTrajectoryMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/DisplayTrajectory";
  static auto layout(auto& m) { return fields_of(m.model_id, m.parts, m.start); }

  struct Floating {
    static constexpr std::string_view ros_type = "trajectory_msgs/MultiDOFJointTrajectory";
    static auto layout(auto& m) { return fields_of(m.header, m.joint_names, m.points); }

    struct Point {
      static constexpr std::string_view ros_type = "trajectory_msgs/MultiDOFJointTrajectoryPoint";
      static auto layout(auto& m) {
        return fields_of(m.transforms, m.velocities, m.accelerations, m.time_from_start);
      }

      std::vector<MultiDofJointStateMessage::Transform> transforms = {};
      std::vector<MultiDofJointStateMessage::Twist> velocities = {}, accelerations = {};
      JointTrajectoryMessage::Duration time_from_start = {};
    };
    MessageHeader header = {};
    std::vector<std::string> joint_names = {};
    std::vector<Point> points = {};
  };
  struct Part {
    static constexpr std::string_view ros_type = "moveit_msgs/RobotTrajectory";
    static auto layout(auto& m) { return fields_of(m.joints, m.floating); }

    JointTrajectoryMessage joints = {};
    Floating floating = {};
  };

  std::string model_id = {};
  std::vector<Part> parts = {};
  RobotStateMessage start = {};
};

struct AllowedCollisionMatrixMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/AllowedCollisionMatrix";
  static auto layout(auto& m) {
    return fields_of(m.entry_names, m.entry_values, m.default_names, m.default_values);
  }

  struct Entry {
    static constexpr std::string_view ros_type = "moveit_msgs/AllowedCollisionEntry";
    static auto layout(auto& m) { return fields_of(m.enabled); }

    std::vector<std::uint8_t> enabled = {};
  };
  std::vector<std::string> entry_names = {};
  std::vector<Entry> entry_values = {};
  std::vector<std::string> default_names = {};
  std::vector<std::uint8_t> default_values = {};
};

/// The beginning of MoveIt's planning scene, without octomap and is_diff.
struct PlanningSceneMessage {
  static constexpr std::string_view ros_type = "moveit_msgs/PlanningScene";
  static constexpr bool is_beginning = true;
  static auto layout(auto& m) {
    return fields_of(m.name, m.robot_state, m.robot_model_name, m.fixed_frames, m.collisions,
                     m.paddings, m.scales, m.colors, m.world);
  }

  struct Padding {
    static constexpr std::string_view ros_type = "moveit_msgs/LinkPadding";
    static auto layout(auto& m) { return fields_of(m.link_name, m.padding); }

    std::string link_name = {};
    double padding = 0;
  };
  struct Scale {
    static constexpr std::string_view ros_type = "moveit_msgs/LinkScale";
    static auto layout(auto& m) { return fields_of(m.link_name, m.scale); }

    std::string link_name = {};
    double scale = 0;
  };
  struct Rgba {
    static constexpr std::string_view ros_type = "std_msgs/ColorRGBA";
    static auto layout(auto& m) { return fields_of(m.r, m.g, m.b, m.a); }

    float r = 0, g = 0, b = 0, a = 0;
  };
  struct Color {
    static constexpr std::string_view ros_type = "moveit_msgs/ObjectColor";
    static auto layout(auto& m) { return fields_of(m.id, m.color); }

    std::string id = {};
    Rgba color = {};
  };
  struct World {
    static constexpr std::string_view ros_type = "moveit_msgs/PlanningSceneWorld";
    static auto layout(auto& m) { return fields_of(m.objects); }

    std::vector<CollisionObjectMessage> objects = {};
  };
  std::string name = {};
  RobotStateMessage robot_state = {};
  std::string robot_model_name = {};
  std::vector<TransformMessage> fixed_frames = {};
  AllowedCollisionMatrixMessage collisions = {};
  std::vector<Padding> paddings = {};
  std::vector<Scale> scales = {};
  std::vector<Color> colors = {};
  World world = {};
};

}  // namespace penumbra::io
