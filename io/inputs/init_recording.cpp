// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/bag/bag_reader.hpp>
#include <io/files/camera_info.hpp>
#include <io/files/detections_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/frame_pattern.hpp>
#include <io/files/image_file.hpp>
#include <io/files/joint_file.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/printable.hpp>
#include <io/files/video_file.hpp>
#include <io/inputs/init_recording.hpp>

namespace penumbra::io {
namespace {

namespace fs = std::filesystem;

constexpr int most_levels = 3;

/// Images of one pattern, or a video.
struct Sequence {
  std::string pattern;  // relative to the folder
  std::size_t count = 0;
  bool is_depth = false;
  ImageSize size = {};
  std::string fault = {};  // of names that are times
};

/// Returns the files of a folder and those below it, sorted, relative to it.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_hidden = name.starts_with('.') || without_controls(name) != name;
    if (entry->is_directory(ignored)) {
      if (is_hidden || entry.depth() + 1 >= most_levels) entry.disable_recursion_pending();
    } else if (!is_hidden && entry->is_regular_file(ignored)) {
      files.push_back(fs::relative(entry->path(), folder, ignored));
    }
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

bool ends_with(const fs::path& file, std::initializer_list<std::string_view> endings) {
  const std::string ending = lower(file.extension().string());
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// Returns "depth/%06d.png" for "depth/000012.png" and "depth/%t.png" for a time, or nothing for a
/// name without a number.
std::string pattern_of(const fs::path& file) {
  constexpr std::string_view digits = "0123456789";
  constexpr std::size_t seconds = 9, milliseconds = 13;  // digits of times since 1973
  const std::string name = file.filename().string();
  const std::size_t dot = name.rfind('.');
  const std::size_t end = name.find_last_of(digits, dot);
  if (end == std::string::npos) return {};
  const auto first_of = [&](std::size_t last) {
    const std::size_t before = name.find_last_not_of(digits, last);
    return before == std::string::npos ? 0 : before + 1;
  };
  std::size_t first = first_of(end);
  const std::size_t count = end + 1 - first;
  if (name.find('%') != std::string::npos) return {};
  const bool is_padded = count > 1 && name[first] == '0';
  std::string number = is_padded ? "%0" + std::to_string(count) + "d" : "%d";
  const std::size_t whole = first < 2 || name[first - 1] != '.' ? first : first_of(first - 2);
  if (whole + seconds < first || count >= milliseconds) {
    number = "%t";
    first = std::min(first, whole);
  } else if (count > 9) {
    return {};
  }
  return (file.parent_path() / (name.substr(0, first) + number + name.substr(end + 1))).string();
}

/// Says what the images of a pattern are; null: neither depth nor colour.
std::optional<Sequence> sequence_of(const std::string& pattern, const fs::path& folder,
                                    const FrameStamps& stamps) {
  const FramePattern files(pattern, folder, stamps);
  Sequence found{.pattern = pattern};
  if (files.is_video()) {
    const auto look = [&](const auto& video, bool is_depth) {
      found.count = video.frames();
      found.size = video.size();
      found.is_depth = is_depth;
      return found;
    };
    try {
      return look(VideoFile<std::uint16_t>(files.file(0)), true);
    } catch (const InputError&) {
      return look(VideoFile<Rgb8>(files.file(0)), false);
    }
  }
  const std::vector<std::int64_t> numbers = files.existing();
  if (numbers.empty()) return std::nullopt;
  found.count = numbers.size();
  found.fault = files.fault();
  const auto unmatched =
      std::ranges::count_if(numbers, [&](std::int64_t number) { return !stamps.contains(number); });
  if (files.is_by_time() && found.fault.empty() && unmatched > 0)
    found.fault = std::to_string(unmatched) + " of " + std::to_string(found.count) +
                  " images have no row whose stamp is their time";
  const fs::path first = files.file(numbers.front());
  SharedDepth depth;
  Image<Rgb8> color;
  if (read_depth(first, std::nullopt, std::nullopt, depth).ok()) {
    found.is_depth = true;
    std::visit([&](const auto& view) { found.size = {view.width, view.height}; }, depth.view);
  } else if (read_color(first, std::nullopt, color).ok()) {
    found.size = {color.width(), color.height()};
  } else {
    return std::nullopt;
  }
  return found;
}

/// Returns the stamps of the first joint file that has some.
FrameStamps stamps_in(const std::vector<fs::path>& files, const fs::path& folder) {
  for (const fs::path& file : files)
    if (ends_with(file, {".csv"})) try {
        if (FrameStamps stamps = read_frame_stamps(folder / file); !stamps.empty()) return stamps;
      } catch (const InputError&) {  // another table
      }
  return {};
}

std::vector<Sequence> sequences_of(const std::vector<fs::path>& files, const fs::path& folder) {
  const FrameStamps stamps = stamps_in(files, folder);
  std::vector<std::string> patterns;
  for (const fs::path& file : files) {
    const bool is_image =
        ends_with(file, {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".npy"});
    const std::string pattern = is_image              ? pattern_of(file)
                                : is_video_name(file) ? file.string()
                                                      : std::string();
    if (!pattern.empty() && std::find(patterns.begin(), patterns.end(), pattern) == patterns.end())
      patterns.push_back(pattern);
  }
  std::vector<Sequence> found;
  for (const std::string& pattern : patterns) try {
      if (auto sequence = sequence_of(pattern, folder, stamps))
        found.push_back(std::move(*sequence));
    } catch (const InputError&) {  // a video that cannot be read
    }
  return found;
}

/// Names say which of several images are meant; others are worse.
int worth(const Sequence& sequence) {
  const std::string name = lower(sequence.pattern);
  const auto holds = [&](std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return name.find(word) != std::string::npos; });
  };
  if (holds({"mask", "label", "link", "overlay", "filtered", "truth", "vdi", "second"})) return -1;
  return holds(sequence.is_depth
                   ? std::initializer_list<std::string_view>{"depth"}
                   : std::initializer_list<std::string_view>{"color", "colour", "rgb", "image"})
             ? 1
             : 0;
}

const Sequence* best_of(const std::vector<Sequence>& all, bool is_depth) {
  const Sequence* best = nullptr;
  for (const Sequence& sequence : all)
    if (sequence.is_depth == is_depth && worth(sequence) >= 0 &&
        (best == nullptr || worth(sequence) > worth(*best)))
      best = &sequence;
  return best;
}

/// Returns the files that `read` reads. `fault`: of the last one that it refuses.
template <typename Read>
std::vector<fs::path> those_that(const std::vector<fs::path>& files,
                                 std::initializer_list<std::string_view> endings, const Read& read,
                                 std::string* fault = nullptr) {
  std::vector<fs::path> found;
  for (const fs::path& file : files) {
    if (!ends_with(file, endings)) continue;
    try {
      read(file);
      found.push_back(file);
    } catch (const InputError& error) {
      if (fault != nullptr && lower(file.string()).find("joint") != std::string::npos)
        *fault = error.what();
    }
  }
  return found;
}

std::string yaml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

/// The lines of the recording.yaml, and what it lacks.
class Draft {
 public:
  void line(const std::string& text) { text_ << text << '\n'; }
  void value(const std::string& key, const std::string& value, const std::string& note = {}) {
    text_ << "  " << key << ": " << yaml_text(value) << (note.empty() ? "" : "   # " + note)
          << '\n';
  }
  void lack(const std::string& key, const std::string& what) {
    text_ << "  # " << key << ": " << what << '\n';
    lacking.push_back(key + ": " + what);
  }
  /// Writes the only file, or the first of several.
  void one_of(const std::string& key, const std::vector<fs::path>& files, const std::string& none) {
    if (files.empty()) {
      needed.push_back(key);
      return lack(key, none);
    }
    value(key, files.front().string());
    for (std::size_t i = 1; i < files.size(); ++i)
      lacking.push_back(key + ": " + files.front().string() + " was taken; " + files[i].string() +
                        " would also do");
  }
  void images(const std::string& key, const Sequence& found) {
    value(key, found.pattern,
          std::to_string(found.count) + (found.count == 1 ? " image of " : " images of ") +
              std::to_string(found.size.width) + " x " + std::to_string(found.size.height));
    if (!found.fault.empty()) lacking.push_back(key + ": " + found.pattern + ": " + found.fault);
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

  std::vector<std::string> lacking, needed;

 private:
  std::ostringstream text_;
};

/// Returns whether the first element of a file is <mujoco>.
bool is_mjcf(const fs::path& file) {
  constexpr std::size_t longest_head = 1U << 16U;  // with comments, as of a licence
  std::string text(longest_head, '\0');
  InputFile input;
  text.resize(input.open(file).ok() ? input.read(text.data(), text.size()) : 0);
  std::size_t at = text.find('<');
  while (at != std::string::npos && at + 1 < text.size() && std::strchr("?!", text[at + 1])) {
    if (text.compare(at, 4, "<!--") == 0) at = text.find("-->", at);
    at = text.find('<', at + 1);
  }
  constexpr std::string_view root = "<mujoco";
  return at != std::string::npos && text.compare(at, root.size(), root) == 0 &&
         text.find_first_of(" \t\r\n/>", at) == at + root.size();
}

fs::path robot_file(const InitOptions& options, const std::vector<fs::path>& files) {
  if (options.robot) return fs::relative(*options.robot, options.folder);
  std::vector<fs::path> robots;
  for (const std::string_view ending : {".urdf", ".urdf.xacro", ".xml"})
    if (robots.empty())  // a URDF may be made of the others
      std::ranges::copy_if(files, std::back_inserter(robots), [&](const fs::path& file) {
        return lower(file.filename().string()).ends_with(ending) &&
               (ending != ".xml" || is_mjcf(options.folder / file));
      });
  if (robots.empty())
    throw InputError(options.folder.string() +
                     ": holds no URDF, .urdf.xacro or MJCF; name the robot's by --robot FILE");
  if (robots.size() > 1)
    throw InputError(options.folder.string() + ": holds several robots, " + robots[0].string() +
                     " and " + robots[1].string() + "; choose one by --robot");
  return robots.front();
}

constexpr const char* is_a_bag =
    ": is a bag, which needs no recording.yaml: `penumbra run` judges its images, `penumbra cloud` "
    "its clouds";

void check_folder(const InitOptions& options) {
  std::error_code error;
  if (!fs::is_directory(options.folder, error))
    throw InputError(options.folder.string() +
                     (is_bag_file(options.folder) ? is_a_bag : ": is no folder of images"));
  if (!options.force && fs::exists(fs::symlink_status(options.folder / "recording.yaml", error)))
    throw InputError((options.folder / "recording.yaml").string() +
                     ": exists; replace it by --force");
}

void write_robot(Draft& draft, const InitOptions& options, const fs::path& urdf) {
  draft.line("robot:");
  draft.value("urdf", urdf.string());
  if (!options.packages.empty()) draft.line("  packages:");
  for (const auto& [name, folder] : options.packages)
    draft.line("    " + name + ": " + yaml_text(fs::relative(folder, options.folder).string()));
  if (!options.arguments.empty()) draft.line("  arguments:");
  for (const auto& [name, value] : options.arguments)
    draft.line("    " + yaml_text(name) + ": " + yaml_text(value));
}

/// Returns whether there is a pose.
bool write_camera(Draft& draft, const InitOptions& options, const std::vector<fs::path>& files,
                  const Sequence* images, const std::string& root) {
  const auto infos = those_that(files, {".yaml", ".yml", ".json"}, [&](const fs::path& file) {
    constexpr std::uintmax_t most_bytes = 1U << 16U;  // labels of images are larger, and many
    std::error_code ignored;
    if (fs::file_size(options.folder / file, ignored) > most_bytes) throw InputError("too large");
    const Camera camera = read_camera_info(options.folder / file, false);
    const ImageSize size{camera.intrinsics.width(), camera.intrinsics.height()};
    if (images != nullptr && size != images->size) throw InputError("is of another camera");
  });
  const auto poses = those_that(
      files, {".csv", ".txt", ".npy", ".yaml", ".yml", ".json"},
      [&](const fs::path& file) { static_cast<void>(read_pose_csv(options.folder / file)); });
  draft.line("camera:");
  draft.one_of(
      "info", infos,
      "camera_info YAML of the images' size; ros2 topic echo --once .../camera_info prints "
      "it");
  if (poses.empty()) {
    draft.lack("pose",
               "4 x 4, metres: optical frame to the link that carries the camera; "
               "penumbra calibrate --search finds it, without depth from --masks");
    return false;
  }
  draft.value("parent", root, "guessed: the robot's root. The link that the pose is given in");
  draft.lacking.push_back("parent: " + root + " is a guess; write the link that " +
                          poses.front().string() + " is given in");
  draft.one_of("pose", poses, "");
  return true;
}

void write_frames(Draft& draft, const InitOptions& options, const std::vector<fs::path>& files,
                  const Sequence* depth, const Sequence* color, const Robot& robot) {
  std::string fault;
  const auto joints = those_that(
      files, {".csv"},
      [&](const fs::path& file) {
        static_cast<void>(read_joint_file(options.folder / file, robot));
      },
      &fault);
  std::string variables;
  for (const std::string& name : robot.variables())
    variables += (variables.empty() ? "" : ",") + name;
  draft.line("frames:");
  draft.one_of("joints", joints,
               "a CSV file with the header frame,[stamp,]" + variables + " (radians, metres)" +
                   (fault.empty() ? "" : "; " + fault));
  if (depth != nullptr)
    draft.images("depth", *depth);
  else
    draft.lack("depth",
               "none: verdicts come from the model; images of a depth camera have 16 bits "
               "(millimetres) or floats (metres), as depth_%d.png");
  if (color != nullptr)
    draft.images("color", *color);
  else
    draft.line("  # color: color_%d.png, for pictures");
}

/// A targets.yaml, else the files of detectors.
std::vector<fs::path> target_files(const InitOptions& options, const std::vector<fs::path>& files,
                                   const ImageSize& size) {
  if (std::find(files.begin(), files.end(), "targets.yaml") != files.end()) return {"targets.yaml"};
  std::vector<fs::path> found;
  for (const fs::path& file : files) {
    if (!is_detections_name(file)) continue;
    try {
      if (!read_detections((options.folder / file).string(), {},
                           Intrinsics(size.width, size.height, size.width, size.width, 0, 0), {}, 0)
               .empty())
        found.push_back(file);
    } catch (const InputError&) {  // another table or text
    }
  }
  return found;
}

}  // namespace

InitResult init_recording(const InitOptions& options) {
  check_folder(options);
  const std::vector<fs::path> files = files_below(options.folder);
  const std::vector<Sequence> sequences = sequences_of(files, options.folder);
  const Sequence* const depth = best_of(sequences, true);
  const Sequence* color = best_of(sequences, false);
  if (depth == nullptr && color == nullptr)
    throw InputError(
        options.folder.string() +
        (is_bag_folder(options.folder)
             ? is_a_bag
             : ": holds no images with a number or a time in their names, and no video"));
  const fs::path urdf = robot_file(options, files);
  RobotOptions robot_options;
  robot_options.packages = options.packages;
  robot_options.arguments = options.arguments;
  robot_options.allow_missing_meshes = true;
  const Robot robot = Robot::load(options.folder / urdf, robot_options);
  Draft draft;
  draft.line(
      "# Written by penumbra init; docs/recording.md explains all keys. Paths are relative to "
      "this file.");
  write_robot(draft, options, urdf);
  for (const LinkReport& link : robot.report())
    if (!link.fault.empty()) draft.lacking.push_back("robot: " + link.fault);
  InitResult result{.file = options.folder / "recording.yaml"};
  if (depth != nullptr && color != nullptr && depth->size != color->size) {
    draft.lacking.push_back("color: " + color->pattern +
                            " is of another size than depth: give the "
                            "colour camera's info, and camera.depth_info and depth_pose");
    color = nullptr;
  }
  result.has_pose = write_camera(draft, options, files, depth != nullptr ? depth : color,
                                 std::string(robot.links().front()));
  write_frames(draft, options, files, depth, color, robot);
  if (const std::vector<fs::path> targets =
          target_files(options, files, depth != nullptr ? depth->size : color->size);
      !targets.empty())
    draft.line("targets: " + yaml_text(targets.front().string()));
  const std::string text = draft.text();
  std::error_code error;
  if (fs::is_symlink(result.file, error)) fs::remove(result.file, error);  // not what it leads to
  PendingFile pending(result.file);
  write_file(pending.part(), text.data(), text.size());
  pending.finish();
  result.lacking = std::move(draft.lacking);
  result.needed = std::move(draft.needed);
  result.has_depth = depth != nullptr;
  return result;
}

}  // namespace penumbra::io
