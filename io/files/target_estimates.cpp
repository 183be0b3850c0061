// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include <io/files/target_shapes.hpp>

namespace penumbra::io {
namespace {

/// Returns the covariance for the sigmas of position and, if given, orientation.
Matrix6d covariance_of(std::span<const double> sigmas) {
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    const double sigma = sigmas[i];
    if (!is_in(detail::positive, sigma))
      throw InputError("sigma of the estimate is " + std::to_string(sigma) +
                       "; expected 1e-9 to 1e9 (metres, of orientation radians)");
    covariance.diagonal().segment<3>(3 * static_cast<Eigen::Index>(i)).setConstant(sigma * sigma);
  }
  return covariance;
}

TargetEstimate estimate_of(const FrameValue& value, bool is_pose, const ReferenceFrame& link) {
  TargetEstimate estimate{.stamp = value.stamp, .frame = link};
  if (is_pose)
    estimate.value = isometry_of(value.numbers);
  else
    estimate.value = position_of(value.numbers);
  const auto sigmas = std::span(value.numbers).subspan(is_pose ? 7 : 3);
  if (!sigmas.empty()) estimate.covariance = covariance_of(sigmas);
  check_estimate(estimate);
  return estimate;
}

}  // namespace

EstimateSource read_estimate(const TargetReader& reader, const YamlNode& node) {
  node.allow_only({"pose", "point", "link"});
  const YamlNode* pose = node.find("pose");
  if ((pose == nullptr) == (node.find("point") == nullptr))
    node.fail("expected one of pose: [x, y, z, qx, qy, qz, qw] and point: [x, y, z]");
  const ReferenceFrame link = link_of(node, reader.context.robot);
  const bool is_pose = pose != nullptr;
  const auto make = [=](const FrameValue& value) { return estimate_of(value, is_pose, link); };
  const auto values =
      reader.values(is_pose ? *pose : node.at("point"),
                    is_pose ? pose_format({"position_sigma", "orientation_sigma"})
                            : fixed_format({"x", "y", "z"}, {"sigma"}),
                    [&](const FrameValue& value) { static_cast<void>(make(value)); });
  const auto of_frame = [=](std::int64_t index) {
    const FrameValue value = values->at(index);
    const bool is_missing = !value.fault.empty() && value.place.empty();
    return is_missing ? TargetEstimate{.value = std::monostate{}} : made_of(value, make);
  };
  return {of_frame, is_pose};
}

}  // namespace penumbra::io
