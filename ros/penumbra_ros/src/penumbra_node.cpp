// SPDX-License-Identifier: Apache-2.0
#include "penumbra_node.hpp"

#include <string_view>

#include <rclcpp_components/register_node_macro.hpp>

namespace penumbra_ros {
namespace {

using penumbra::io::DiagnosticStatusMessage;
using penumbra::io::LiveRunner;
using std_srvs::srv::SetBool;
using std_srvs::srv::Trigger;

constexpr std::chrono::seconds check_period{1};

/// Returns the status that a line of DiagnosticChanges is about, or null.
const DiagnosticStatusMessage* subject_of(const penumbra::io::DiagnosticArrayMessage& statuses,
                                          std::string_view line) {
  for (const DiagnosticStatusMessage& status : statuses.status)
    if (line.substr(0, status.name.size()) == status.name) return &status;
  return nullptr;
}

}  // namespace

PenumbraNode::PenumbraNode(const rclcpp::NodeOptions& options)
    : Node("penumbra", options),
      settings_(declare_settings(*this)),
      look_ahead_(*this),
      outputs_(*this, settings_.target_frames, settings_.live.cameras[0].mount.frame_prefix,
               look_ahead_),
      runner_(settings_.live, settings_.pipeline, {&outputs_}),
      inputs_(*this, runner_),
      diagnostics_(LiveRunner::steady_now(), {.name = get_name()}),
      updater_(this) {
  outputs_.select(settings_.publish);
  look_ahead_.set_rule(settings_.pipeline.rule);
  runner_.watch(0, outputs_);
  updater_.setHardwareID(get_fully_qualified_name());
  updater_.add("robot", [this](auto& status) { report(status, 0); });
  updater_.add("camera", [this](auto& status) { report(status, 1); });
  reset_ = create_service<Trigger>(
      "~/reset", [this](const Trigger::Request::SharedPtr, Trigger::Response::SharedPtr response) {
        runner_.forget();
        response->success = true;
      });
  enable_ = create_service<SetBool>("~/enable", [this](const SetBool::Request::SharedPtr request,
                                                       SetBool::Response::SharedPtr response) {
    enable(request->data);
    response->success = true;
  });
  on_change_ = add_on_set_parameters_callback(
      [this](const std::vector<rclcpp::Parameter>& changes) { return change(changes); });
  warn_of_unknown_parameters();
  inputs_.follow(false, enabled_);
  timer_ = create_wall_timer(check_period, [this] { check(); });
  runner_.start();
  // Nothing can be published once the context is shut down.
  before_shutdown_ = get_node_base_interface()->get_context()->add_pre_shutdown_callback(
      [this] { runner_.stop(); });
}

PenumbraNode::~PenumbraNode() {
  get_node_base_interface()->get_context()->remove_pre_shutdown_callback(before_shutdown_);
  runner_.stop();
}

void PenumbraNode::warn_of_unknown_parameters() {
  // Parameters with a point are of QoS and of plugins, which declare them later.
  for (const auto& [name, value] : get_node_parameters_interface()->get_parameter_overrides())
    if (!has_parameter(name) && name.find('.') == std::string::npos)
      RCLCPP_WARN(get_logger(), "there is no parameter '%s'", name.c_str());
}

rcl_interfaces::msg::SetParametersResult PenumbraNode::change(const Changes& changes) {
  rcl_interfaces::msg::SetParametersResult result;
  try {
    settings_.pipeline.rule = read_rule(*this, changes);
    outputs_.select(read_publish(*this, changes));
    runner_.configure(settings_.pipeline);
    look_ahead_.set_rule(settings_.pipeline.rule);
    result.successful = true;
  } catch (const std::exception& error) {
    result.successful = false;
    result.reason = error.what();
  }
  return result;
}

void PenumbraNode::enable(bool enabled) {
  enabled_ = enabled;
  inputs_.follow(false, enabled_);
}

void PenumbraNode::check() {
  if (runner_.has_failed() &&
      failure_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    failed_.set_exception(runner_.fault());
    RCLCPP_FATAL(get_logger(), "nothing is judged any more; load the node again");
  }
  inputs_.follow(outputs_.wants(penumbra::io::Result::overlay), enabled_);
  const auto links = inputs_.links();
  statuses_ = runner_.with_inbox([&](const penumbra::io::LiveInbox& inbox) {
    return diagnostics_.report(inbox, links, {LiveRunner::steady_now(), now().nanoseconds()});
  });
  DiagnosticStatusMessage& camera = statuses_.status[1];
  if (!enabled_) {
    camera.level = DiagnosticStatusMessage::ok;
    camera.message = "disabled by ~/enable";
  }
  if (runner_.has_failed()) {
    camera.level = DiagnosticStatusMessage::error;
    camera.message = "nothing is judged any more";
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
  if (statuses_.status.empty()) return status.summary(DiagnosticStatusMessage::stale, "starting");
  const DiagnosticStatusMessage& from = statuses_.status[number];
  status.summary(from.level, from.message);
  for (const auto& [key, value] : from.values) status.add(key, value);
}

}  // namespace penumbra_ros

RCLCPP_COMPONENTS_REGISTER_NODE(penumbra_ros::PenumbraNode)
