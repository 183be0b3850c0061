// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/attached_input.hpp>
#include <io/assembly/frame_tree.hpp>
#include <io/assembly/joint_names.hpp>
#include <io/assembly/plan_input.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A robot and the history of its poses.
struct PosedRobot {
  /// `compare_sources`: see JointBufferOptions and TransformBufferOptions.
  PosedRobot(Robot what, bool compare_sources);
  PosedRobot(const PosedRobot&) = delete;
  PosedRobot& operator=(const PosedRobot&) = delete;

  /// Returns the messages that the history refused, one line each.
  [[nodiscard]] std::vector<std::string> refusals() const;
  /// Returns the pose of a link in another one at the newest states of the joints between them, up
  /// to `stamp`. Returns nothing if a link or a joint's position is not known.
  [[nodiscard]] std::optional<Eigen::Isometry3d> find_pose(const std::string& target,
                                                           const std::string& source,
                                                           std::int64_t stamp) const;

  const Robot robot;
  PoseHistory history;
};

/// A received URDF.
struct RobotDescription {
  std::string robot;  ///< its name among several robots; empty: it is the only one
  std::string text;
};

/// Makes the robot, or joins several robots (Robot::join): each stands where static transforms put
/// its root, frame ROBOT/LINK, in the frame "world". `options`: link names of `extra` are those of
/// the result. Throws InputError.
[[nodiscard]] Robot robot_of(std::span<const RobotDescription> descriptions,
                             std::span<const TransformMessage> static_transforms,
                             const std::filesystem::path& folder, const RobotOptions& options);

struct RobotInputOptions {
  std::vector<std::string> names = {""};  ///< of the robots that are received
  RobotOptions robot = {};                ///< for robots that are received
  std::optional<Robot> given = {};        ///< used in place of received descriptions
  /// The names that joint states have for the joints, if they differ: see JointNames.
  std::string joint_names = {};
  bool compare_sources = true;  ///< see JointBufferOptions and TransformBufferOptions
  /// Known before their messages, as from a bag; of one child frame the first one.
  std::vector<TransformMessage> static_transforms = {};
};

/// A received robot that has to be made. Reading its meshes takes time.
struct RobotLoadRequest {
  std::uint64_t number = 0;  ///< number of RobotInput
  std::vector<RobotDescription> descriptions;
  std::vector<TransformMessage> static_transforms;
  RobotOptions options;
  bool compare_sources = true;  ///< see RobotInputOptions
};

/// The outcome of a request: a robot, or the reason why it could not be made.
struct MadeRobot {
  std::uint64_t number = 0;  ///< the number of the request
  std::shared_ptr<PosedRobot> robot;
  std::string fault;
};

/// Makes a robot. Any thread may call this.
[[nodiscard]] MadeRobot make_robot(const RobotLoadRequest& request);

/// The robot of a graph, from robot_description, joint states and transforms, and what is attached
/// to it.
class RobotInput {
 public:
  explicit RobotInput(RobotInputOptions options);

  /// Receives a description. A new text requests a new robot and forgets the old robot and its
  /// joint states, because they may be wrong now: there is no robot until the new one is made. The
  /// same text again has no effect, unless its robot could not be made: then it is tried again.
  /// Does nothing if the robot is given. `robot`: its name among several, which are made once all
  /// are there.
  void take(const StringMessage& description, const std::string& robot);
  /// Returns the robot to make, once, or null if there is none.
  [[nodiscard]] std::unique_ptr<const RobotLoadRequest> take_load_request() {
    return std::move(request_);
  }
  [[nodiscard]] bool has_load_request() const { return request_ != nullptr; }
  /// Requests a robot again that could not be made: its meshes may exist now.
  void retry();
  /// Takes a made robot. Does nothing if another description was received since.
  void set_robot(MadeRobot made);
  /// Forgets the joint states and transforms, except static transforms.
  void forget() {
    if (posed_) replace(std::make_shared<PosedRobot>(posed_->robot, options_.compare_sources));
  }
  /// Receives joint states. `source`: the publisher, see MessageSources; `robot`: the name before
  /// the joints' names, if there are several robots.
  void take(const JointStateMessage& message, const std::string& robot, std::string_view source,
            std::int64_t now);
  /// Notes the joints of a topic that is not used.
  void take_unused(const JointStateMessage& message, const std::string& topic);
  void take(const TfMessage& message, bool is_static, std::string_view source, std::int64_t now);
  /// Receives what is attached (`M`: AttachedObjectMessage, PlanningSceneMessage). Returns what
  /// cannot be drawn, one line, or nothing. `robot`: its name among several.
  template <typename M>
  std::string take_attached(const M& message, const std::string& robot) {
    std::string fault = attached_.take(message, last_stamp_, attachments_, robot, posed_.get());
    if (posed_) posed_->history.attachments() = attachments_;
    return fault;
  }

  /// Receives a motion (`M`: JointTrajectoryMessage, DisplayTrajectoryMessage). Returns why it
  /// cannot be used, one line, or nothing. `robot`: its name among several.
  template <typename M>
  std::string take_plan(const M& message, const std::string& robot) {
    if (!posed_) return "the robot is not known yet";
    JointAnswer now;
    posed_->history.joints().at(last_stamp_, now);
    for (const JointGap& gap : now.gaps)
      now.positions[gap.variable] = posed_->robot.rest_positions()[gap.variable];
    return plan_.take(message, robot, posed_->robot, now.positions);
  }
  [[nodiscard]] const std::shared_ptr<const Trajectory>& plan() const { return plan_.plan(); }

  /// Returns the robot, or null if there is none; fault() says why.
  [[nodiscard]] const std::shared_ptr<PosedRobot>& posed() const { return posed_; }
  /// Returns why the received robot could not be made; empty if it was made or none was received.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Returns whether a robot was received that is not made yet.
  [[nodiscard]] bool is_being_made() const { return placed_ != requests_; }

  /// Returns a number that grows when TF names a new frame.
  [[nodiscard]] std::uint64_t frames_revision() const { return frames_revision_; }
  [[nodiscard]] const FrameTree& frames() const { return frames_; }

  [[nodiscard]] std::size_t robots() const { return robots_; }  ///< number of robots made
  /// Return when the last joint state and transform arrived, on the caller's clock.
  [[nodiscard]] std::optional<std::int64_t> last_joints() const { return last_joints_; }
  [[nodiscard]] std::optional<std::int64_t> last_transforms() const { return last_transforms_; }
  [[nodiscard]] std::int64_t last_stamp() const { return last_stamp_; }  ///< of its states
  /// Returns when the last joint state arrived that had a position of this robot.
  [[nodiscard]] std::optional<std::int64_t> last_used_joints() const { return last_used_joints_; }
  /// Returns which topics have joints that were never seen, one line each.
  [[nodiscard]] std::vector<std::string> unused_topics() const;
  /// Returns the least time from a joint state's stamp to its arrival, nanoseconds.
  [[nodiscard]] const std::optional<std::int64_t>& joint_lag() const { return joint_lag_; }
  /// Returns why the last unused joint state was not used.
  [[nodiscard]] const std::string& unused_joints() const { return unused_joints_; }

 private:
  void replace(std::shared_ptr<PosedRobot> robot);
  void use(const JointStateMessage& message, std::string_view source, std::int64_t now);
  void request_load();
  /// The places of several robots are made of static transforms.
  void retry_with_new_transforms();

  RobotInputOptions options_;
  JointNames joint_names_;
  std::shared_ptr<PosedRobot> posed_;
  std::map<std::string, std::string> descriptions_;  // the last received one of each robot
  std::unique_ptr<const RobotLoadRequest> request_;
  std::uint64_t requests_ = 0,
                placed_ = 0;  // numbers of the last request and of the last robot made
  std::string fault_;
  FrameTree frames_;
  std::uint64_t frames_revision_ = 0;
  std::map<std::string, TransformMessage> static_transforms_;  // by child; published only once
  std::size_t requested_transforms_ = 0;                       // of the last request
  AttachedInput attached_;
  PlanInput plan_;
  Attachments attachments_;      // of this and of later robots
  std::int64_t last_stamp_ = 0;  // of joint states and moving transforms
  std::size_t robots_ = 0;
  std::optional<std::int64_t> last_joints_, last_transforms_, last_used_joints_;
  std::string unused_joints_;
  std::map<std::string, std::string> topics_of_joints_;  // that are not used, of each joint
  std::optional<std::int64_t> joint_lag_;
};

}  // namespace penumbra::io
