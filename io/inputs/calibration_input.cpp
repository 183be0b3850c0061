// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/pose_stage.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/png.hpp>
#include <io/inputs/calibration_input.hpp>

namespace penumbra::io {
CalibrationInput read_calibration_input(const CalibrationInputOptions& options,
                                        const LineSink& print, const std::function<void()>& step) {
  RunInput input = open_input(options.input, print);
  std::optional<FramePattern> masks;
  const auto& path = options.input.path;
  if (options.masks)
    masks.emplace(*options.masks, std::filesystem::is_directory(path) ? path : path.parent_path(),
                  input.stamps);

  const bool has_depth = input.config.has_depth;
  if (!has_depth && !masks && !options.images)
    throw InputError(path.string() + ": has no depth: give --images or --masks");
  if (options.images && masks)
    throw InputError("--images: --masks is given too; leave one of them out");
  const auto source = input.frames();
  Frame frame;
  KeptFrames frames(
      input.robot, *input.camera,
      {.choice = options.time_offset ? KeptFrames::Choice::moving : KeptFrames::Choice::rest_first,
       .needs_depth = has_depth && !options.images,
       .parent = find_camera_parent(input.robot, input.camera->parent)});
  std::size_t lacking = 0;  // frames without a mask or a colour image
  std::string first_lack;
  const auto pass = [&] {
    try {
      return frames.pass(frame);
    } catch (const InputError& error) {
      throw InputError(path.string() + ": " + error.what());
    }
  };
  while (source->next(frame)) {
    step();
    std::optional<KeptFrame> kept = pass();
    if (!kept) continue;
    if (masks) {
      Image<std::uint8_t> mask;
      const auto file = masks->file(static_cast<std::int64_t>(kept->index));
      if (!std::filesystem::exists(file)) {
        if (lacking++ == 0) first_lack = file.string() + " is not there";
        continue;
      }
      if (const FileResult read = read_png(
              file, mask,
              ImageSize{input.camera->intrinsics.width(), input.camera->intrinsics.height()});
          !read.ok())
        throw InputError("--masks: " + read.message);
      kept->mask = frames.image_of(std::as_const(mask).view());
    }
    if (options.images) {
      if (frame.color.view.empty()) {
        if (lacking++ == 0) first_lack = frame.color_message;
        continue;
      }
      kept->color = frames.image_of(frame.color.view);
    } else if (has_depth)
      kept->depth =
          frames.depth_of(frame.depth.view, {input.camera->range.near, input.camera->range.far});
    frames.add(*std::move(kept));
  }
  if (frame.pose_at && frame.stamp) {  // the poses after the last image
    *frame.stamp += 300'000'000;
    frame.pose_at(*frame.stamp, frame.pose);
    frames.follow(frame);
  }

  if (frames.T_parent_camera()) input.camera->T_parent_camera = frames.T_parent_camera();
  CalibrationInput result{.input = std::move(input),
                          .camera = frames.camera(),
                          .frames = frames.chosen(),
                          .T_by_tf = frames.T_parent_camera(),
                          .seen = frames.seen(),
                          .notes = source->notes()};
  const std::string what = options.images ? "--images" : "--masks";
  if (lacking > 0 && result.frames.empty())
    throw InputError(what + ": " +
                     (first_lack.empty() ? path.string() + " has no colour images" : first_lack));
  if (lacking > 0)
    result.notes.push_back(what + ": frames without one are left out: " + std::to_string(lacking) +
                           "; the first: " + first_lack);
  std::ranges::move(frames.notes(), std::back_inserter(result.notes));
  return result;
}

}  // namespace penumbra::io
