// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/calibration/problem.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/tuning/missing_parts.hpp>

namespace penumbra {

SetupCheck::SetupCheck(const Robot& robot, const Camera& camera, std::size_t camera_parent,
                       Images images)
    : robot_(robot),
      parent_(camera_parent),
      images_(images),
      kept_(robot, camera,
            {.most = images == Images::color ? most_by_color : most,
             .needs_depth = images != Images::color,
             .parent = camera_parent,
             .camera_stays = false,
             .columns = columns}) {}

void SetupCheck::add(const FrameReport& report, std::span<const double> joints,
                     const std::function<void()>& draw, const ImageView<const Rgb8>& color) {
  if (!kept_.is_usable(report)) return;
  pixels_ += static_cast<std::size_t>(report.labels.width) *
             static_cast<std::size_t>(report.labels.height);
  measured_ += report.pixels.front + report.pixels.occluded + report.pixels.beyond;
  elsewhere_ += report.pixels.front + report.pixels.beyond;
  std::optional<KeptFrame> frame = kept_.pass(report, joints);
  if (!frame) return;
  if (draw) draw();
  if (images_ == Images::color) {
    if (!kept_.is_size(color.width, color.height)) return;
    frame->color = kept_.image_of(color);
    kept_.add(*std::move(frame));
    return;
  }
  frame->depth = kept_.depth_of(report.depth);
  if (images_ == Images::depth) {  // whose labels are those of a scan
    frame->labels = kept_.image_of(report.labels);
    frame->links = kept_.image_of(report.virtual_depth.links);
  }
  kept_.add(*std::move(frame));
}

Diagnosis SetupCheck::diagnose() const {
  // Of the robot's measured pixels those that are measured elsewhere; its measured pixels of all.
  constexpr double most_elsewhere = 0.05, least_measured = 0.002;
  const std::span<const KeptFrame> frames = kept_.frames();
  const bool by_color = images_ == Images::color;
  if (frames.empty() || (by_color && !calibration::stands_still(frames, parent_))) return {};
  const auto measured = static_cast<double>(measured_);
  const bool is_suspicious = by_color ||
                             static_cast<double>(elsewhere_) > most_elsewhere * measured ||
                             measured < least_measured * static_cast<double>(pixels_);
  return penumbra::diagnose(frames, kept_.camera(), kept_.raw_camera(), robot_, parent_,
                            *kept_.T_parent_camera(), is_suspicious, images_ == Images::scans);
}

std::vector<std::string> SetupCheck::missing_parts(int fringe_reach) const {
  if (images_ != Images::depth) return {};         // the fringe of scans has other causes
  const int reach = fringe_reach / kept_.block();  // of the kept images
  return penumbra::missing_parts(kept_.frames(), robot_, reach);
}

}  // namespace penumbra
