// SPDX-License-Identifier: Apache-2.0
#include "penumbra_node.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include <lifecycle_msgs/msg/state.hpp>
#include <rclcpp_components/register_node_macro.hpp>

#include <penumbra/base/error.hpp>

namespace penumbra_ros {
namespace {

using penumbra::io::DiagnosticStatusMessage;
using penumbra::io::LiveRunner;
using std_srvs::srv::Trigger;

constexpr std::chrono::seconds check_period{1};

/// Returns what the names of a camera's topics and services begin with.
std::string names_below(const penumbra::io::CameraInputOptions& camera) {
  return camera.name.empty() ? "~/" : "~/" + camera.name + "/";
}

/// Returns the status that a line of DiagnosticChanges is about, or null.
const DiagnosticStatusMessage* subject_of(const penumbra::io::DiagnosticArrayMessage& statuses,
                                          std::string_view line) {
  for (const DiagnosticStatusMessage& status : statuses.status)
    if (line.substr(0, status.name.size() + 1) == status.name + ":") return &status;
  return nullptr;
}

/// Returns the names without those of cameras before them.
std::set<std::string> last_parts_of(const std::map<std::string, bool>& parameters) {
  std::set<std::string> names;
  for (const auto& [name, can_change] : parameters) names.insert(name.substr(name.rfind('.') + 1));
  return names;
}

}  // namespace

PenumbraNode::PenumbraNode(const rclcpp::NodeOptions& options)
    : LifecycleNode("penumbra", options), settings_(read_settings(*this)), updater_(this) {
  updater_.setHardwareID(get_fully_qualified_name());
  add_diagnostics();
  on_change_ = add_on_set_parameters_callback(
      [this](const std::vector<rclcpp::Parameter>& changes) { return change(changes); });
  warn_of_unknown_parameters();
  if (settings_.autostart) {
    configure();  // logs a fault, and goes on
    if (activate().id() != lifecycle_msgs::msg::State::PRIMARY_STATE_ACTIVE)
      throw std::runtime_error("the node could not be configured: see the message above");
  }
  // Nothing can be published once the context is shut down.
  before_shutdown_ = get_node_base_interface()->get_context()->add_pre_shutdown_callback([this] {
    if (runner_) runner_->stop();
  });
}

PenumbraNode::~PenumbraNode() {
  get_node_base_interface()->get_context()->remove_pre_shutdown_callback(before_shutdown_);
  clean_up();
}

PenumbraNode::CallbackReturn PenumbraNode::on_configure(const rclcpp_lifecycle::State& /*former*/) {
  try {
    settings_ = read_settings(*this);
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_logger(), "%s", error.what());
    return CallbackReturn::FAILURE;
  }
  add_diagnostics();
  make_outputs();
  inputs_ = std::make_unique<Inputs>(*this, *runner_);
  diagnostics_.emplace(
      LiveRunner::steady_now(),
      penumbra::io::DiagnosticSource{.name = get_name(),
                                     .how_to_forget = "call ~/reset to forget the former",
                                     .parameters = last_parts_of(settings_.parameters)});
  reset_ = create_service<Trigger>(
      "~/reset", [this](const Trigger::Request::SharedPtr, Trigger::Response::SharedPtr response) {
        runner_->forget();
        response->success = true;
      });
  inputs_->follow(false, active_);
  timer_ = create_wall_timer(check_period, [this] { check(); });
  runner_->start();
  return CallbackReturn::SUCCESS;
}

void PenumbraNode::make_outputs() {
  // Names are resolved by this node, parameters of QoS and of plugins are its own.
  rclcpp::NodeOptions options;
  options.use_global_arguments(false).start_parameter_services(false);
  options.use_intra_process_comms(get_node_options().use_intra_process_comms());
  for (const auto& [name, value] : get_node_parameters_interface()->get_parameter_overrides())
    options.append_parameter_override(name, value);
  images_ =
      std::make_shared<rclcpp::Node>(std::string(get_name()) + "_images", get_namespace(),
                                     options.context(get_node_base_interface()->get_context()));
  std::vector<penumbra::io::ResultSink*> sinks;
  for (const penumbra::io::CameraInputOptions& camera : settings_.live.cameras) {
    outputs_.push_back(std::make_unique<Outputs>(
        *this, *images_, names_below(camera), settings_.target_frames, camera.mount.frame_prefix));
    outputs_.back()->select(settings_.publish);
    outputs_.back()->set_rule(settings_.pipeline.rule);
    sinks.push_back(outputs_.back().get());
  }
  for (const std::string& topic : settings_.cloud_topics) {
    clouds_.push_back(std::make_unique<CloudOutputs>(*this, topic));
    sinks.push_back(clouds_.back().get());
  }
  runner_ = std::make_unique<LiveRunner>(settings_.live, settings_.pipeline, sinks);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    runner_->watch(i, *outputs_[i]);
    calibrations_.push_back(std::make_unique<CalibrationServices>(
        *this, names_below(settings_.live.cameras[i]), *runner_, i));
  }
  if (outputs_.size() > 1) fuse();
}

PenumbraNode::CallbackReturn PenumbraNode::on_activate(const rclcpp_lifecycle::State& /*former*/) {
  active_ = true;  // from the next check on: MoveIt's service is discovered by then
  return CallbackReturn::SUCCESS;
}

PenumbraNode::CallbackReturn PenumbraNode::on_deactivate(
    const rclcpp_lifecycle::State& /*former*/) {
  active_ = false;
  inputs_->follow(wants_overlay(), active_);
  return CallbackReturn::SUCCESS;
}

PenumbraNode::CallbackReturn PenumbraNode::on_cleanup(const rclcpp_lifecycle::State& /*former*/) {
  clean_up();
  // Otherwise the executor goes on waiting for what is gone.
  get_node_base_interface()->trigger_notify_guard_condition();
  return CallbackReturn::SUCCESS;
}

PenumbraNode::CallbackReturn PenumbraNode::on_shutdown(const rclcpp_lifecycle::State& former) {
  return on_cleanup(former);
}

void PenumbraNode::clean_up() {
  active_ = false;
  if (runner_) runner_->stop();
  timer_.reset();
  reset_.reset();
  inputs_.reset();
  calibrations_.clear();
  runner_.reset();
  fusion_.reset();
  target_views_.reset();
  clouds_.clear();
  outputs_.clear();
  images_.reset();
  statuses_ = {};
  changes_ = {};
}

void PenumbraNode::fuse() {
  target_views_ = rclcpp::create_publisher<penumbra_msgs::msg::TargetViews>(
      *this, "~/target_views", rclcpp::QoS(result_depth), with_qos_parameters());
  std::vector<std::string> cameras;
  for (const penumbra::io::CameraInputOptions& camera : settings_.live.cameras)
    cameras.push_back(camera.name);
  fusion_.emplace(cameras, [this](std::span<const std::byte> payload) {
    if (target_views_->get_subscription_count() > 0)
      target_views_->publish(deserialised<penumbra_msgs::msg::TargetViews>(payload));
  });
  runner_->fuse(*fusion_);
}

/// Adds the robot, the cameras and the clouds, in the order of LiveDiagnostics, in place of former
/// ones.
void PenumbraNode::add_diagnostics() {
  std::vector<std::string> names{"robot"};
  for (const penumbra::io::CameraInputOptions& camera : settings_.live.cameras)
    names.push_back(camera.name.empty() ? "camera" : "camera " + camera.name);
  for (const penumbra::io::CloudInputOptions& cloud : settings_.live.clouds)
    names.push_back("cloud " + cloud.topic);
  if (names == subjects_) return;
  for (const std::string& former : subjects_) updater_.removeByName(former);
  subjects_ = names;
  for (std::size_t i = 0; i < names.size(); ++i)
    updater_.add(names[i], [this, i](auto& status) { report(status, i); });
}

bool PenumbraNode::wants_overlay() const {
  return std::any_of(outputs_.begin(), outputs_.end(), [](const auto& outputs) {
    return outputs->wants(penumbra::io::Result::overlay);
  });
}

void PenumbraNode::warn_of_unknown_parameters() {
  const auto& cameras = settings_.live.cameras;
  const bool have_names = !cameras.empty() && !cameras.front().name.empty();
  // Others with a point are of QoS and of plugins, which declare them later.
  for (const auto& [name, value] : get_node_parameters_interface()->get_parameter_overrides())
    if (!has_parameter(name) &&
        (name.find('.') == std::string::npos || name.rfind("cameras.", 0) == 0))
      RCLCPP_WARN(get_logger(), "there is no parameter '%s'%s", name.c_str(),
                  have_names ? "; those of cameras are cameras.NAME.PARAMETER" : "");
}

rcl_interfaces::msg::SetParametersResult PenumbraNode::change(const Changes& changes) {
  rcl_interfaces::msg::SetParametersResult result;
  try {
    for (const rclcpp::Parameter& parameter : changes) {
      const auto found = settings_.parameters.find(parameter.get_name());
      if (runner_ && found != settings_.parameters.end() && !found->second)
        throw penumbra::InputError("parameter '" + found->first +
                                   "' is read when the node is configured: clean it up before");
    }
    const penumbra::LabelRule rule = read_rule(*this, changes);
    settings_.publish = read_publish(*this, changes);
    settings_.pipeline.rule = rule;  // both are kept, or none
    for (const auto& outputs : outputs_) {
      outputs->select(settings_.publish);
      outputs->set_rule(settings_.pipeline.rule);
    }
    if (runner_) runner_->configure(settings_.pipeline);
    result.successful = true;
  } catch (const std::exception& error) {
    result.successful = false;
    result.reason = error.what();
  }
  return result;
}

void PenumbraNode::check() {
  if (runner_->has_failed() &&
      failure_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    failed_.set_exception(runner_->fault());
    RCLCPP_FATAL(get_logger(), "nothing is judged any more; clean up and configure the node again");
  }
  inputs_->follow(wants_overlay(), active_);
  const auto links = inputs_->links();
  statuses_ = runner_->with_inbox([&](const penumbra::io::LiveInbox& inbox) {
    return diagnostics_->report(inbox, links, {LiveRunner::steady_now(), now().nanoseconds()});
  });
  if (fusion_) fusion_->add_contradictions(statuses_);
  runner_->add_calibrations(statuses_);
  for (std::size_t i = 1; i < statuses_.status.size(); ++i) {  // the first is the robot's
    DiagnosticStatusMessage& sensor = statuses_.status[i];
    if (!active_) {
      sensor.level = DiagnosticStatusMessage::ok;
      sensor.message = "inactive";
    } else if (inputs_->waits_for_scene()) {
      sensor.level = DiagnosticStatusMessage::warn;
      sensor.message = "waits for MoveIt to say what is attached (get_planning_scene)";
    }
    if (runner_->has_failed()) {
      sensor.level = DiagnosticStatusMessage::error;
      sensor.message = "nothing is judged any more";
    }
  }
  for (const std::string& line : changes_.update(statuses_)) {
    const DiagnosticStatusMessage* status = subject_of(statuses_, line);
    if (status == nullptr || status->level == DiagnosticStatusMessage::ok ||
        status->level == DiagnosticStatusMessage::stale)
      RCLCPP_INFO(get_logger(), "%s", line.c_str());
    else
      RCLCPP_WARN(get_logger(), "%s", line.c_str());
  }
}

void PenumbraNode::report(diagnostic_updater::DiagnosticStatusWrapper& status, std::size_t number) {
  if (statuses_.status.empty())
    return status.summary(DiagnosticStatusMessage::stale, "not configured");
  const DiagnosticStatusMessage& from = statuses_.status[number];
  status.summary(from.level, from.message);
  for (const auto& [key, value] : from.values) status.add(key, value);
}

}  // namespace penumbra_ros

RCLCPP_COMPONENTS_REGISTER_NODE(penumbra_ros::PenumbraNode)
