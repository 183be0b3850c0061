// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <unordered_set>
#include <utility>

#include <io/files/frame_reader.hpp>
#include <io/files/npy.hpp>
#include <io/files/png.hpp>

namespace penumbra::io {
namespace {

/// Returns depth in metres from one in units of `scale` metres.
template <typename T>
std::shared_ptr<const Image<float>> scaled(const Image<T>& depth, double scale) {
  auto metres = std::make_shared<Image<float>>(depth.width(), depth.height());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const T value = depth.data()[i];
    if (metres_of(value) > 0.0F) metres->data()[i] = static_cast<float>(scale * value);
  }
  return metres;
}

/// Reads a depth image of a format. `scale`: metres per unit; null: the format's.
template <typename T, typename Read>
FileResult read_depth(const Read& read, std::optional<double> scale, SharedDepth& depth) {
  auto image = std::make_shared<Image<T>>();
  FileResult result = read(*image);
  if (!result.ok()) return result;
  if (scale)
    depth = SharedDepth(scaled(*image, *scale));
  else
    depth = SharedDepth(std::shared_ptr<const Image<T>>(std::move(image)));
  return result;
}

/// Adds a faulty row for every depth image without a row, before the first row of a later frame.
std::vector<JointRow> with_gaps(std::vector<JointRow> rows, const RecordingFrames& files) {
  std::unordered_set<std::int64_t> known;
  for (const JointRow& row : rows) known.insert(row.index);
  std::vector<std::int64_t> lacking = files.depth.existing();
  std::erase_if(lacking, [&](std::int64_t index) { return known.contains(index); });
  if (lacking.empty()) return rows;

  std::vector<JointRow> all;
  auto next = lacking.begin();
  const auto add_lacking = [&] {
    JointRow& row = all.emplace_back();
    row.index = *next;
    row.fault = files.joints.string() + " has no row for frame " + std::to_string(*next);
    ++next;
  };
  for (JointRow& row : rows) {
    while (next != lacking.end() && *next < row.index) add_lacking();
    all.push_back(std::move(row));
  }
  while (next != lacking.end()) add_lacking();
  return all;
}

}  // namespace

FrameReader::FrameReader(const Recording& recording, const Robot& robot)
    : size_{recording.camera.camera.intrinsics.width(),
            recording.camera.camera.intrinsics.height()},
      files_(recording.frames),
      depth_scale_(recording.camera.depth_scale),
      rows_(with_gaps(read_joint_file(recording.frames.joints, robot), recording.frames)),
      bodies_(recording.attached),
      parts_(robot.parts().begin(), robot.parts().end()) {}

Frame FrameReader::read(std::size_t i, bool with_color) const {
  const JointRow& row = rows_[i];
  Frame frame{.index = static_cast<std::size_t>(row.index), .stamp = row.stamp};
  frame.pose.positions = row.positions;
  // A joint row is of the frame's own stamp.
  if (row.stamp && !row.positions.empty()) frame.pose.age = 0;
  if (!row.fault.empty() && row.faulty_parts.empty()) {
    frame.pose.status = FrameStatus::missing_joints;
    frame.pose.message = row.fault;
  }
  frame.pose.uncertain_reason = row.fault;
  for (const std::size_t part : row.faulty_parts)
    for (std::size_t link = parts_[part].first_link; link < parts_[part].end_link; ++link)
      frame.pose.uncertain_links.push_back(link);
  for (const RecordedBody& each : bodies_)
    if (each.first <= row.index && row.index < each.end) frame.pose.attached.push_back(each.body);

  const std::filesystem::path file = files_.depth.file(row.index);
  const FileResult depth =
      files_.depth.has_extension(".npy")
          ? read_depth<float>([&](auto& image) { return read_npy(file, image, size_); },
                              depth_scale_, frame.depth)
          : read_depth<std::uint16_t>([&](auto& image) { return read_png(file, image, size_); },
                                      depth_scale_, frame.depth);
  if (!depth.ok()) {
    frame.source_status =
        depth.status == FileStatus::missing ? FrameStatus::missing_depth : FrameStatus::bad_depth;
    frame.source_message = depth.message;
  }
  if (!with_color || !files_.color) return frame;
  auto color = std::make_shared<Image<Rgb8>>();
  frame.color_message = read_png(files_.color->file(row.index), *color, size_).message;
  if (frame.color_message.empty())
    frame.color = SharedColor(std::shared_ptr<const Image<Rgb8>>(std::move(color)));
  return frame;
}

}  // namespace penumbra::io
