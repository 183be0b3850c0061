// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <mutex>
#include <numeric>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/registration.hpp>

#include <io/files/depth_pixels.hpp>
#include <io/files/frame_reader.hpp>
#include <io/files/image_file.hpp>
#include <io/files/ray_depth.hpp>

namespace penumbra::io {
namespace {

/// Adds a faulty row for every depth image without a row, before the first row of a later frame.
/// `lacking`: the images' numbers, ascending. `by_time`: names them, or null.
std::vector<JointRow> with_gaps(std::vector<JointRow> rows, std::vector<std::int64_t> lacking,
                                const std::filesystem::path& joint_file,
                                const FramePattern* by_time) {
  std::unordered_set<std::int64_t> known;
  for (const JointRow& row : rows) known.insert(row.index);
  std::erase_if(lacking, [&](std::int64_t index) { return known.contains(index); });
  if (lacking.empty()) return rows;

  std::vector<JointRow> all;
  auto next = lacking.begin();
  const auto add_lacking = [&] {
    JointRow& row = all.emplace_back();
    row.index = *next;
    row.fault = joint_file.string() + " has no row for " +
                (by_time != nullptr ? by_time->file(*next).string() + ", by its time"
                                    : "frame " + std::to_string(*next));
    ++next;
  };
  for (JointRow& row : rows) {
    while (next != lacking.end() && *next < row.index) add_lacking();
    all.push_back(std::move(row));
  }
  while (next != lacking.end()) add_lacking();
  return all;
}

template <typename T>
std::shared_ptr<VideoFile<T>> video_of(const FramePattern* pattern, ImageSize size) {
  if (pattern == nullptr || !pattern->is_video()) return nullptr;
  auto video = std::make_shared<VideoFile<T>>(pattern->file(0));
  if (video->size() != size)
    throw InputError(pattern->file(0).string() + ": " + wrong_size(video->size(), size));
  return video;
}

template <typename T>
std::vector<std::int64_t> numbers_of(const FramePattern& images, const VideoFile<T>* video) {
  if (video == nullptr) return images.existing();
  std::vector<std::int64_t> numbers(video->frames());
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Returns the pattern of numbers_of_images() if it is of times.
const FramePattern* by_time(const RecordingFrames& files) {
  const auto& images = files.depth ? files.depth : files.color;
  return images && images->is_by_time() ? &*images : nullptr;
}

ImageSize size_of(const Camera& camera) {
  return {camera.intrinsics.width(), camera.intrinsics.height()};
}

}  // namespace

/// Brings images of a depth camera into the camera's image, in several threads.
class FrameReader::DepthCamera {
 public:
  explicit DepthCamera(const RecordingCamera& camera)
      : camera_(camera.camera), depth_(*camera.depth), T_camera_depth_(camera.T_camera_depth) {}

  [[nodiscard]] ImageSize size() const { return size_of(depth_); }

  SharedDepth warp(const SharedDepth& depth) {
    std::unique_ptr<DepthRegistration> registration;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        registration = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (!registration) registration = std::make_unique<DepthRegistration>(depth_, camera_);
    SharedDepth warped =
        std::visit([](const auto& view) { return shared_depth_of(copy_of(view), {}); },
                   registration->warp(depth.view, T_camera_depth_));
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(registration));
    return warped;
  }

 private:
  Camera camera_, depth_;
  Eigen::Isometry3d T_camera_depth_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<DepthRegistration>> idle_;
};

FrameReader::FrameReader(const Recording& recording, const Robot& robot)
    : size_(size_of(recording.camera.camera)),
      files_(recording.frames),
      depth_video_(video_of<std::uint16_t>(
          files_.depth ? &*files_.depth : nullptr,
          recording.camera.depth ? size_of(*recording.camera.depth) : size_)),
      color_video_(video_of<Rgb8>(files_.color ? &*files_.color : nullptr, size_)),
      depth_camera_(recording.camera.depth ? std::make_shared<DepthCamera>(recording.camera)
                                           : nullptr),
      depth_scale_(recording.camera.depth_scale),
      z_of_ray_(recording.camera.depth_along_ray
                    ? z_of_rays(recording.camera.depth.value_or(recording.camera.camera))
                    : Image<float>()),
      rows_(with_gaps(read_joint_file(files_.joints, robot), numbers_of_images(), files_.joints,
                      by_time(files_))),
      bodies_(recording.attached),
      robot_(robot),
      camera_parent_(robot.find_link(recording.camera.camera.parent).value_or(0)) {}

/// The numbers of the depth images; without any, of the colour images.
std::vector<std::int64_t> FrameReader::numbers_of_images() const {
  if (files_.depth) return numbers_of(*files_.depth, depth_video_.get());
  if (files_.color) return numbers_of(*files_.color, color_video_.get());
  return {};
}

RobotPose pose_of(const JointRow& row, const Robot& robot, std::size_t camera_parent,
                  std::span<const RecordedBody> bodies) {
  RobotPose pose;
  // A joint row is of the frame's own stamp.
  if (row.stamp && !row.positions.empty()) pose.age = 0;
  for (const RecordedBody& each : bodies)
    if (each.first <= row.index && row.index < each.end) pose.attached.push_back(each.body);
  pose.positions = row.positions;
  if (row.fault.empty()) return pose;
  if (row.unknown.empty() || !leave_out(row.unknown, robot, camera_parent, pose)) {
    pose.positions.clear();
    pose.age.reset();
    pose.status = FrameStatus::missing_joints;
    pose.message = row.fault;
  }
  pose.uncertain_reason = row.fault;
  return pose;
}

Frame FrameReader::read(std::size_t i, bool with_color) const {
  const JointRow& row = rows_[i];
  Frame frame{.index = static_cast<std::size_t>(row.index), .stamp = row.stamp};
  frame.pose = pose_of(row, robot_, camera_parent_, bodies_);
  const FileResult depth = files_.depth ? read_depth_image(row.index, frame.depth) : FileResult{};
  if (!depth.ok()) {
    frame.source_status =
        depth.status == FileStatus::missing ? FrameStatus::missing_depth : FrameStatus::bad_depth;
    frame.source_message = depth.message;
  }
  if (with_color && files_.color)
    frame.color_message = read_color_image(row.index, frame.color).message;
  return frame;
}

FileResult FrameReader::read_depth_image(std::int64_t index, SharedDepth& depth) const {
  FileResult result;
  if (depth_video_) {
    std::shared_ptr<const Image<std::uint16_t>> image;
    result = depth_video_->read(static_cast<std::size_t>(index), image);
    if (result.ok())
      depth = depth_scale_ ? shared_depth_of(*image, depth_scale_) : SharedDepth(image);
  } else {
    result = read_depth(files_.depth->file(index), depth_camera_ ? depth_camera_->size() : size_,
                        depth_scale_, depth);
  }
  if (result.ok() && z_of_ray_.width() > 0) depth = along_z(depth.view, z_of_ray_);
  if (result.ok() && depth_camera_) depth = depth_camera_->warp(depth);
  return result;
}

FileResult FrameReader::read_color_image(std::int64_t index, SharedColor& color) const {
  std::shared_ptr<const Image<Rgb8>> image;
  FileResult result;
  if (color_video_) {
    result = color_video_->read(static_cast<std::size_t>(index), image);
  } else {
    auto read = std::make_shared<Image<Rgb8>>();
    result = read_color(files_.color->file(index), size_, *read);
    image = std::move(read);
  }
  if (result.ok()) color = SharedColor(image);
  return result;
}

}  // namespace penumbra::io
