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
  if (!has_depth && !masks) throw InputError(path.string() + ": has no depth: give --masks");
  const auto source = input.frames();
  Frame frame;
  KeptFrames frames(
      input.robot, *input.camera,
      {.choice = options.time_offset ? KeptFrames::Choice::moving : KeptFrames::Choice::rest_first,
       .needs_depth = has_depth,
       .parent = find_camera_parent(input.robot, input.config.camera_parent)});
  std::size_t unmasked = 0;
  std::string no_mask;
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
        if (unmasked++ == 0) no_mask = file.string();
        continue;
      }
      if (const FileResult read = read_png(
              file, mask,
              ImageSize{input.camera->intrinsics.width(), input.camera->intrinsics.height()});
          !read.ok())
        throw InputError("--masks: " + read.message);
      kept->mask = frames.image_of(std::as_const(mask).view());
    }
    if (has_depth)
      kept->depth =
          frames.depth_of(frame.depth.view, {input.camera->range.near, input.camera->range.far});
    frames.add(*std::move(kept));
  }
  if (frame.pose_at && frame.stamp) {  // the poses after the last image
    *frame.stamp += 300'000'000;
    frame.pose_at(*frame.stamp, frame.pose);
    frames.follow(frame);
  }

  if (frames.T_parent_camera()) input.config.T_parent_camera = *frames.T_parent_camera();
  CalibrationInput result{.input = std::move(input),
                          .camera = frames.camera(),
                          .frames = frames.chosen(),
                          .T_by_tf = frames.T_parent_camera(),
                          .seen = frames.seen(),
                          .notes = source->notes()};
  if (unmasked > 0 && result.frames.empty())
    throw InputError("--masks: " + no_mask + " is not there");
  if (unmasked > 0)
    result.notes.push_back("frames without a mask are left out: " + std::to_string(unmasked) +
                           ", the first " + no_mask);
  std::ranges::move(frames.notes(), std::back_inserter(result.notes));
  return result;
}

}  // namespace penumbra::io
