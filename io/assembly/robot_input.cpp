// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/assembly/arrivals.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/files/printable.hpp>
#include <io/files/recording.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_named = 3;
/// Nanoseconds after its last joint state from which a robot may have moved unseen.
constexpr std::int64_t longest_silence = 1'000'000'000;

/// Returns why no position of a joint state is used.
std::string why_unused(const JointStateMessage& message, const Robot& robot) {
  const auto is_known = [&](const std::string& name) {
    const auto names = robot.variables();
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (std::none_of(message.names.begin(), message.names.end(), is_known)) {
    std::string names;
    for (std::size_t i = 0; i < std::min(message.names.size(), most_named); ++i)
      names += (i == 0 ? "" : ", ") + printable(message.names[i]);
    if (message.names.size() > most_named) names += ", ...";
    return "joint states name none of the robot's joints: " + (names.empty() ? "no name" : names);
  }
  if (message.header.stamp <= 0) return "joint states have no stamp";
  return "joint states hold no position that can be used";
}

PoseHistoryOptions history_options(bool compare_sources) {
  PoseHistoryOptions options;
  options.joints.compare_sources = options.transforms.compare_sources = compare_sources;
  return options;
}

/// Returns T_world_frame by static transforms.
Eigen::Isometry3d mount_of(const std::string& frame, std::span<const TransformMessage> all) {
  Eigen::Isometry3d T_at_frame = Eigen::Isometry3d::Identity();
  std::string at = frame;
  for (std::size_t i = 0; i <= all.size() && at != "world"; ++i)
    for (const TransformMessage& t : all)
      if (frame_name(t.child_frame_id) == at) {
        T_at_frame = t.T_parent_child * T_at_frame;
        at = frame_name(t.header.frame_id);
        break;
      }
  if (at == "world") return T_at_frame;
  throw InputError("tf_static does not say where frame '" + printable(frame) +
                   "' is in frame 'world'");
}

}  // namespace

Robot robot_of(std::span<const RobotDescription> descriptions,
               std::span<const TransformMessage> static_transforms,
               const std::filesystem::path& folder, const RobotOptions& options) {
  if (descriptions.size() == 1 && descriptions.front().robot.empty())
    return Robot::parse(descriptions.front().text, folder, options);
  std::vector<std::string> names;
  for (const RobotDescription& description : descriptions) names.push_back(description.robot);
  check_robots_of(options.joints, names);
  std::vector<PlacedRobot> robots;
  for (const auto& [name, text] : descriptions) {
    RobotOptions own = options;
    own.extra = extra_of(options.extra, name);
    own.ignore_links = patterns_of(options.ignore_links, name);
    own.joints = joints_of(options.joints, name);
    const Robot robot = Robot::parse(text, folder, own);
    robots.push_back(
        {name, robot, mount_of(name + "/" + robot.links().front(), static_transforms)});
  }
  return Robot::join(robots);
}

PosedRobot::PosedRobot(Robot what, bool compare_sources)
    : robot(std::move(what)), history(robot, history_options(compare_sources)) {}

std::vector<std::string> PosedRobot::refusals() const {
  std::vector<std::string> lines;
  if (history.clock_jumps() > 0) lines.push_back(history.last_jump());
  if (history.joint_states_without_stamp() > 0)
    lines.push_back(std::to_string(history.joint_states_without_stamp()) +
                    " joint states without a stamp are not used");
  if (const std::size_t refused = history.joints().refused_values(); refused > 0)
    lines.push_back("joint positions not used: " + std::to_string(refused) +
                    " (absent, not finite, beyond 1e9, or of a quaternion not of length 1)");
  if (history.transforms().refused() > 0)
    lines.push_back("transforms are not used, the last: " + history.transforms().last_refusal());
  return lines;
}

std::optional<Eigen::Isometry3d> PosedRobot::find_pose(const std::string& target,
                                                       const std::string& source,
                                                       std::int64_t stamp) const {
  const auto a = robot.find_link(target), b = robot.find_link(source);
  if (!a || !b) return std::nullopt;
  std::vector<bool> is_between(robot.links().size());  // above one of the two links only
  for (const std::size_t end : {*a, *b})
    for (std::size_t link = end; link > 0; link = robot.joints()[link - 1].parent)
      is_between[link].flip();
  std::vector<std::size_t> variables;
  for (const Joint& joint : robot.joints()) {
    if (!is_between[joint.child] || !joint.variable) continue;
    const auto newest = history.joints().newest_of({&robot.variables()[*joint.variable], 1});
    const bool is_one = joint.type != JointType::planar && joint.type != JointType::floating;
    if (!newest || !is_one || stamp_after(*newest, longest_silence) < stamp) return std::nullopt;
    stamp = std::min(stamp, *newest);
    variables.push_back(*joint.variable);
  }
  JointAnswer joints;
  history.joints().at(stamp, joints);
  const std::vector<double> rest = robot.rest_positions();
  for (const JointGap& gap : joints.gaps) {
    if (std::count(variables.begin(), variables.end(), gap.variable) > 0) return std::nullopt;
    joints.positions[gap.variable] = rest[gap.variable];
  }
  std::vector<Eigen::Isometry3d> T_root_link(robot.links().size());
  robot.forward_kinematics(joints.positions, T_root_link);
  for (const std::size_t end : {*a, *b})
    if (const RobotPart* const part = robot.part_of(end)) {
      const std::size_t root = part->first_link;
      TransformAnswer mount;
      history.transforms().at(stamp, robot.links()[0], robot.links()[root], mount);
      if (mount.status != TransformStatus::ok) return std::nullopt;
      T_root_link[end] = mount.T_target_source * T_root_link[root].inverse() * T_root_link[end];
    }
  return T_root_link[*a].inverse() * T_root_link[*b];
}

MadeRobot make_robot(const RobotLoadRequest& request) {
  try {
    // The folder is "/", because relative mesh paths would otherwise be resolved from the working
    // folder of the program.
    Robot robot = robot_of(request.descriptions, request.static_transforms, "/", request.options);
    return {request.number,
            std::make_shared<PosedRobot>(std::move(robot), request.compare_sources),
            {}};
  } catch (const InputError& error) {
    return {request.number, nullptr, error.what()};
  }
}

RobotInput::RobotInput(RobotInputOptions options)
    : options_(std::move(options)), joint_names_(options_.joint_names) {
  for (const TransformMessage& t : options_.static_transforms)
    static_transforms_.emplace(t.child_frame_id, t);
  if (options_.given)
    replace(std::make_shared<PosedRobot>(*options_.given, options_.compare_sources));
}

void RobotInput::replace(std::shared_ptr<PosedRobot> robot) {
  posed_ = std::move(robot);
  plan_ = {};
  posed_->history.attachments() = attachments_;
  last_used_joints_.reset();
  unused_joints_.clear();
  for (const auto& [child, t] : static_transforms_)
    posed_->history.add_static_transform(t.header.frame_id, t.child_frame_id, t.T_parent_child);
  ++robots_;
}

void RobotInput::take(const StringMessage& description, const std::string& robot) {
  if (options_.given) return;
  const auto [known, is_new] = descriptions_.try_emplace(robot, description.data);
  if (!is_new && known->second == description.data) return retry();
  known->second = description.data;
  posed_.reset();
  fault_.clear();
  if (descriptions_.size() == options_.names.size()) request_load();
}

void RobotInput::request_load() {
  RobotLoadRequest request{++requests_, {}, {}, options_.robot, options_.compare_sources};
  for (const std::string& name : options_.names)
    request.descriptions.push_back({name, descriptions_.at(name)});
  for (const auto& [child, t] : static_transforms_) request.static_transforms.push_back(t);
  requested_transforms_ = static_transforms_.size();
  request_ = std::make_unique<const RobotLoadRequest>(std::move(request));
}

void RobotInput::retry() {
  if (!fault_.empty() && !is_being_made()) request_load();
}

void RobotInput::set_robot(MadeRobot made) {
  if (made.number != requests_) return;
  placed_ = requests_;
  fault_ = std::move(made.fault);
  if (made.robot) replace(std::move(made.robot));
  retry_with_new_transforms();
}

void RobotInput::retry_with_new_transforms() {
  if (static_transforms_.size() > requested_transforms_) retry();
}

void RobotInput::take(const JointStateMessage& message, const std::string& robot,
                      std::string_view source, std::int64_t now) {
  if (!robot.empty() || !joint_names_.are_same()) {
    JointStateMessage named = message;
    const std::string prefix = robot.empty() ? "" : robot + "/";
    for (std::string& name : named.names) name = prefix + joint_names_.joint_of(name);
    return use(named, source, now);
  }
  use(message, source, now);
}

void RobotInput::use(const JointStateMessage& message, std::string_view source, std::int64_t now) {
  last_joints_ = now;
  note_lag(message.header.stamp, now, joint_lag_);
  last_stamp_ = message.header.stamp;
  if (!posed_) return;
  if (posed_->history.add_joints(message.header.stamp, message.names, message.positions, source) >
      0)
    last_used_joints_ = now;
  else
    unused_joints_ = why_unused(message, posed_->robot);
}

void RobotInput::take_unused(const JointStateMessage& message, const std::string& topic) {
  if (!posed_) return;
  for (const std::string& name : message.names)
    if (const std::string joint = joint_names_.joint_of(name); posed_->robot.find_variable(joint))
      topics_of_joints_.emplace(joint, topic);
}

std::vector<std::string> RobotInput::unused_topics() const {
  std::vector<std::string> lines;
  for (const auto& [joint, topic] : topics_of_joints_)
    if (posed_ && !posed_->history.joints().newest_of({&joint, 1}))
      lines.push_back("joint '" + printable(joint) + "' was never seen, but " + printable(topic) +
                      " has it: name all topics of joint states by --joint-topic");
  return lines;
}

void RobotInput::take(const TfMessage& message, bool is_static, std::string_view source,
                      std::int64_t now) {
  last_transforms_ = now;
  for (const TransformMessage& t : message.transforms) {
    if (frames_.add(t.header.frame_id, t.child_frame_id)) ++frames_revision_;
    if (!is_static) last_stamp_ = t.header.stamp;
    if (is_static && (static_transforms_.contains(t.child_frame_id) ||
                      static_transforms_.size() < FrameTree::max_frames))
      static_transforms_[t.child_frame_id] = t;
    if (!posed_) continue;
    if (is_static)
      posed_->history.add_static_transform(t.header.frame_id, t.child_frame_id, t.T_parent_child);
    else
      posed_->history.add_transform(t.header.stamp, t.header.frame_id, t.child_frame_id,
                                    t.T_parent_child, source);
  }
  retry_with_new_transforms();
}

}  // namespace penumbra::io
