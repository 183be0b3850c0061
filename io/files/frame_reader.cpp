// SPDX-License-Identifier: Apache-2.0
#include <type_traits>
#include <unordered_set>
#include <utility>

#include <io/files/frame_reader.hpp>
#include <io/files/npy.hpp>

namespace penumbra::io {
namespace {

template <typename T>
Image<T>& depth_as(FrameData& frame) {
  if (!std::holds_alternative<Image<T>>(frame.depth)) frame.depth.emplace<Image<T>>();
  return std::get<Image<T>>(frame.depth);
}

FileResult read_depth(const FramePattern& pattern, ImageSize size, FrameData& frame) {
  const std::filesystem::path file = pattern.file(frame.index);
  return pattern.has_extension(".npy") ? read_npy(file, depth_as<float>(frame), size)
                                       : read_png(file, depth_as<std::uint16_t>(frame), size);
}

/// Returns depth in metres from one in units of `scale` metres.
template <typename T>
Image<float> scaled(const Image<T>& depth, double scale) {
  Image<float> metres(depth.width(), depth.height());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const T value = depth.data()[i];
    if (metres_of(value) > 0.0F) metres.data()[i] = static_cast<float>(scale * value);
  }
  return metres;
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

DepthView FrameData::depth_view() const {
  return std::visit([](const auto& image) { return DepthView(image.view()); }, depth);
}

Frame frame_of(const FrameData& data) {
  Frame frame;
  frame.stamp = data.stamp;
  frame.depth = data.depth_view();
  frame.joints = data.positions;
  frame.source_status = data.status;
  frame.source_message = data.message;
  frame.uncertain_links = data.uncertain_links;
  frame.uncertain_reason = data.message;
  frame.index = static_cast<std::size_t>(data.index);
  // A recording's joint row is of the frame's own stamp.
  if (data.stamp && !data.positions.empty()) frame.joints.age = 0;
  frame.attached = data.attached;
  return frame;
}

FrameReader::FrameReader(const Recording& recording, const Robot& robot)
    : size_{recording.camera.camera.intrinsics.width(),
            recording.camera.camera.intrinsics.height()},
      files_(recording.frames),
      depth_scale_(recording.camera.depth_scale),
      rows_(with_gaps(read_joint_file(recording.frames.joints, robot), recording.frames)),
      bodies_(recording.attached),
      parts_(robot.parts().begin(), robot.parts().end()) {}

void FrameReader::read(std::size_t i, bool with_color, FrameData& frame) const {
  const JointRow& row = rows_[i];
  frame.index = row.index;
  frame.stamp = row.stamp;
  frame.positions = row.positions;
  const bool is_usable = row.fault.empty() || !row.faulty_parts.empty();
  frame.status = is_usable ? FrameStatus::ok : FrameStatus::missing_joints;
  frame.message = row.fault;
  frame.uncertain_links.clear();
  for (const std::size_t part : row.faulty_parts)
    for (std::size_t link = parts_[part].first_link; link < parts_[part].end_link; ++link)
      frame.uncertain_links.push_back(link);
  frame.attached.clear();
  for (const RecordedBody& each : bodies_)
    if (each.first <= row.index && row.index < each.end) frame.attached.push_back(each.body);

  if (const FileResult depth = read_depth(files_.depth, size_, frame); !depth.ok()) {
    std::visit([](auto& image) { image = std::remove_reference_t<decltype(image)>(); },
               frame.depth);
    if (frame.status == FrameStatus::ok)
      frame.status =
          depth.status == FileStatus::missing ? FrameStatus::missing_depth : FrameStatus::bad_depth;
    frame.message += (frame.message.empty() ? "" : "; ") + depth.message;
  } else if (depth_scale_) {
    frame.depth =
        std::visit([&](const auto& image) { return scaled(image, *depth_scale_); }, frame.depth);
  }

  frame.color_message.clear();
  if (with_color && files_.color) {
    frame.color_message = read_png(files_.color->file(row.index), frame.color, size_).message;
    if (frame.color_message.empty()) return;
  }
  frame.color = Image<Rgb8>();
}

}  // namespace penumbra::io
