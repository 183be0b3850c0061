// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/version.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/camera_views.hpp>
#include <io/files/json.hpp>
#include <io/files/names.hpp>

namespace penumbra::io {
namespace {

Json point_json(const std::optional<Eigen::Vector3d>& point) {
  return point ? Json{point->x(), point->y(), point->z()} : Json(nullptr);
}

Json covariance_json(const Eigen::Matrix3d& covariance) {
  Json values = Json::array();
  for (const double value : covariance.reshaped<Eigen::RowMajor>()) values.push_back(value);
  return values;
}

Json view_json(const std::vector<std::string>& cameras, const CameraView& view) {
  const bool is_measured = view.point.has_value();
  return {{"camera", cameras[view.camera]},
          {"stamp_ns", or_null(view.stamp)},
          {"verdict", to_string(view.verdict)},
          {"reason", or_null(view.reason)},
          {"visible_fraction", view.visible_fraction},
          {"point", point_json(view.point)},
          {"distance_m", is_measured ? Json(view.distance) : Json(nullptr)},
          {"angle_rad", is_measured ? Json(view.angle) : Json(nullptr)}};
}

Json fused_json(const std::vector<std::string>& cameras, const FusedTarget& target) {
  const auto name = [&](std::size_t camera) { return cameras[camera]; };
  Json contradiction, views = Json::array();
  if (const auto& pair = target.contradiction)
    contradiction = {{"cameras", {name(pair->first), name(pair->second)}},
                     {"distance_m", pair->distance},
                     {"chi_square", pair->chi_square}};
  for (const CameraView& view : target.views) views.push_back(view_json(cameras, view));
  return {{"name", target.name},
          {"verdict", to_string(target.verdict)},
          {"reason", or_null(target.reason)},
          {"best", target.best ? Json(name(*target.best)) : Json(nullptr)},
          {"point", point_json(target.point)},
          {"covariance", target.point ? covariance_json(target.covariance) : Json(nullptr)},
          {"contradiction", std::move(contradiction)},
          {"views", std::move(views)}};
}

/// The frames of one stamp, with their cameras.
using Instant = std::vector<std::pair<std::size_t, const CameraFrame*>>;

std::map<std::int64_t, Instant> instants_of(std::span<const CameraRun> runs) {
  std::map<std::int64_t, Instant> instants;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const CameraFrame& frame : runs[i].frames) instants[frame.stamp].emplace_back(i, &frame);
  return instants;
}

TargetFusion fusion_of(std::span<const CameraRun> runs) {
  std::vector<ViewCamera> cameras;
  for (const CameraRun& run : runs) cameras.push_back(run.camera);
  return TargetFusion(std::move(cameras));
}

}  // namespace

void ViewRecorder::take(const Frame& /*frame*/, const FrameReport& report) {
  if (!report.stamp && has_pose(report.status))
    throw InputError("camera '" + run_.camera.name + "': frame " + std::to_string(report.index) +
                     " has no stamp, which matches the cameras' frames; add a column stamp to the "
                     "joint file, or --fps");
  if (report.stamp) run_.frames.push_back(views_of(run_.camera, report));
}

CameraViews fuse_views(const std::string& input, std::span<const CameraRun> runs) {
  TargetFusion fusion = fusion_of(runs);
  CameraViews views{.input = input, .cameras = {}, .frames = {}};
  for (const ViewCamera& camera : fusion.cameras()) views.cameras.push_back(camera.name);
  for (const auto& [stamp, frames] : instants_of(runs)) {
    std::set<std::string> judged;
    for (const auto& [camera, frame] : frames) {
      fusion.add(camera, *frame);
      for (const auto& [name, view] : frame->views) judged.insert(name);
    }
    FusedFrame& fused = views.frames.emplace_back(FusedFrame{stamp, {}});
    for (const std::string& name : judged) fused.targets.push_back(fusion.fused(name));
  }
  return views;
}

std::vector<FusedCounts> counts_of(const CameraViews& views) {
  std::map<std::string, FusedCounts> counts;
  for (const FusedFrame& frame : views.frames)
    for (const FusedTarget& target : frame.targets) {
      FusedCounts& of_target = counts[target.name];
      of_target.name = target.name;
      ++of_target.verdicts[static_cast<std::size_t>(target.verdict)];
      of_target.contradictions += target.contradiction ? 1 : 0;
    }
  std::vector<FusedCounts> all;
  for (auto& [name, of_target] : counts) all.push_back(std::move(of_target));
  return all;
}

std::string views_json(const CameraViews& views) {
  std::string text = "{\"penumbra\": " + json_text(PENUMBRA_VERSION) +
                     ", \"input\": " + json_text(views.input) +
                     ", \"cameras\": " + json_text(views.cameras) + ", \"frames\": [";
  const char* comma = "\n";
  for (const FusedFrame& frame : views.frames) {
    Json targets = Json::array();
    for (const FusedTarget& target : frame.targets)
      targets.push_back(fused_json(views.cameras, target));
    text += std::exchange(comma, ",\n");
    text += json_text({{"stamp_ns", frame.stamp}, {"targets", std::move(targets)}});
  }
  return text + "\n]}\n";
}

std::vector<std::string> cameras_of_views(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(read_whole_file(file, FileLimit::data));
    auto cameras = json.at("cameras").get<std::vector<std::string>>();
    for (const std::string& name : cameras) check_camera_name(name);
    if (!cameras.empty()) return cameras;
  } catch (const Json::exception&) {
  } catch (const InputError& fault) {
    throw InputError(file.string() + ": cameras: " + fault.what());
  }
  throw InputError(file.string() + ": is no views.json of penumbra run");
}

}  // namespace penumbra::io
