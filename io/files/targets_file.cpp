// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/detections_file.hpp>
#include <io/files/frame_values.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/files/target_shapes.hpp>
#include <io/files/targets_file.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// One target and where its parts come from.
struct TargetSource {
  Target settings;  // the same in each frame
  ShapeSource shape;
  std::optional<EstimateSource> estimate;
};

/// How the detections of a class are judged.
struct DetectedClass {
  RegionTarget region = {.region = {}, .extent = Extent::modal};
  Target settings = {};
  std::optional<double> min_score = {};

  [[nodiscard]] bool takes(const Detection& detection) const {
    return !min_score || !detection.score || *detection.score >= *min_score;
  }
};

namespace {

/// Pixels refer to the image that the file names, else to the raw image.
void check_image(const YamlNode& root, const TargetsContext& context) {
  ImageSpace image = ImageSpace::raw;
  const YamlNode* key = root.find("image");
  if (key != nullptr) {
    if (key->text() != "raw" && key->text() != "rectified")
      key->fail("is '" + key->text() + "'; expected raw or rectified");
    if (key->text() == "rectified") image = ImageSpace::rectified;
  }
  if (!context.has_distortion || image == context.image) return;
  const YamlNode* const list = root.find("targets");
  const auto targets = list != nullptr ? list->items() : std::span<const YamlNode>();
  if (root.find("detections") == nullptr &&
      std::none_of(targets.begin(), targets.end(), names_pixels))
    return;
  const YamlNode& blamed = key != nullptr ? *key : root;
  blamed.fail(image == ImageSpace::raw
                  ? "pixels are of the raw image, results of the rectified one; write image: "
                    "rectified if they are of that, or leave --image out"
                  : "pixels are of the rectified image, results of the raw one; use --image "
                    "rectified");
}

std::string frame_id_of(const YamlNode& node, const TargetsContext& context) {
  const YamlNode* frame_id = node.find("frame_id");
  if (frame_id == nullptr) return {};
  const std::string& name = frame_id->text();
  if (name != context.camera_frame)
    frame_id->fail("is '" + printable(name) + "', " +
                   (context.camera_frame.empty()
                        ? "but the camera's frame has no name; leave it out"
                        : "the camera's is '" + printable(context.camera_frame) + "'"));
  return name;
}

TargetSource source_of(const YamlNode& node, const TargetsContext& context,
                       const std::filesystem::path& folder, ValueTables& tables) {
  TargetSource source;
  source.settings.name = node.at("name").text();
  const YamlNode& name = node.at("name");
  name.with_context([&] { check_name(name.text()); });
  const TargetReader reader{node, source.settings.name, context, folder, tables};
  source.shape = read_shape(reader);
  source.settings.frame_id = frame_id_of(node, context);
  if (const YamlNode* estimate = node.find("estimate"))
    source.estimate = read_estimate(reader, *estimate);
  return source;
}

/// Refuses handling without a source of estimates.
void check_handling(const YamlNode& node, const TargetSource& source,
                    const TargetHandling& handling) {
  if (source.estimate && std::holds_alternative<std::monostate>(handling))
    node.at("estimate").fail("is given, but not handled; expected handling: pose or point");
  if (!std::holds_alternative<PoseTrackerConfig>(handling)) return;
  if (source.estimate && !source.estimate->is_pose)
    node.at("handling")
        .fail(
            "is pose, but the estimate has no orientation; write handling: point, or estimate: "
            "{pose: ...}");
  if (!source.estimate && !source.shape.has_pose)
    node.at("handling")
        .fail(
            "is pose, but only box3d and mesh have a pose of their own; write handling: point, or "
            "add "
            "estimate: {pose: ...}");
}

void read_settings(const YamlNode& node, const TargetsContext& context, TargetSource& source) {
  Target& target = source.settings;
  if (const YamlNode* margin = node.find("depth_margin")) {
    target.depth_margin = margin->number();
    margin->with_context([&] { check_target(target); });
  }
  target.thresholds.beyond_hides = context.beyond_hides;
  if (const YamlNode* thresholds = node.find("thresholds"))
    target.thresholds = read_thresholds(*thresholds, target.thresholds);
  if (const YamlNode* handling = node.find("handling")) target.handling = read_handling(*handling);
  check_handling(node, source, target.handling);
  if (source.shape.has_pose && target.thresholds.min_inside > 0)
    node.at("thresholds")
        .at("min_inside")
        .fail(
            "is not possible here: the part of a box3d or a mesh outside of the image is not "
            "known");
}

std::map<std::int64_t, std::string> class_names_of(const YamlNode& node) {
  std::map<std::int64_t, std::string> names;
  if (node.is_list())
    for (const YamlNode& name : node.items())
      names.emplace(static_cast<std::int64_t>(names.size()), name.text());
  else
    for (const YamlNode& name : node.entries()) {
      const auto number = parse_number<std::int64_t>(name.key());
      if (!number) name.fail("is the name of no number; expected {0: person, ...}");
      names.emplace(*number, name.text());
    }
  return names;
}

DetectedClass class_of(const YamlNode& node, const TargetsContext& context) {
  DetectedClass found;
  found.settings.thresholds.beyond_hides = context.beyond_hides;
  if (node.is_null()) return found;
  node.allow_only(
      {"extent", "expected_depth", "height", "thickness", "min_score", "thresholds", "handling"});
  found.region = region_settings(node, Extent::modal);
  if (const YamlNode* thickness = node.find("thickness"))
    found.settings.depth_margin = 0.5 * positive_number(*thickness);
  if (const YamlNode* score = node.find("min_score")) found.min_score = score->number();
  if (const YamlNode* thresholds = node.find("thresholds"))
    found.settings.thresholds = read_thresholds(*thresholds, found.settings.thresholds);
  if (const YamlNode* handling = node.find("handling")) {
    found.settings.handling = read_handling(*handling);
    if (std::holds_alternative<PoseTrackerConfig>(found.settings.handling))
      handling->fail("is pose, but detections have no orientation; expected point");
  }
  return found;
}

const DetectedClass* class_of(const Detection& detection,
                              const std::map<std::string, DetectedClass>& classes) {
  auto found = classes.find(detection.category);
  if (found == classes.end()) found = classes.find("*");
  return found == classes.end() ? nullptr : &found->second;
}

/// Says where the least score decides nothing, or too much.
void check_scores(const Detections& detections, const std::map<std::string, DetectedClass>& classes,
                  std::vector<std::string>& notes) {
  std::size_t limited = 0, unscored = 0, taken = 0;
  double most = 0.0, limit = 0.0;
  for (const auto& [index, found] : detections)
    for (const Detection& detection : found) {
      const DetectedClass* const settings = class_of(detection, classes);
      if (settings == nullptr) continue;
      taken += settings->takes(detection);
      if (!settings->min_score) continue;
      ++limited;
      unscored += !detection.score;
      limit = std::max(limit, *settings->min_score);
      most = std::max(most, detection.score.value_or(0.0));
    }
  if (taken == 0 && limited > 0) notes.push_back("no detection has the score that min_score wants");
  if (unscored > 0)
    notes.push_back(std::to_string(unscored) + " of " + std::to_string(limited) +
                    " detections have no score: min_score leaves none of them out");
  if (most > 1.0 && limit <= 1.0 && limit > 0.0)
    notes.push_back("scores reach " + std::to_string(most) +
                    ", and min_score is at most 1: are they percentages?");
}

/// Refuses classes without a detection: their names may be missing in `names`.
void check_classes(const YamlNode& node, const Detections& detections,
                   const std::map<std::string, DetectedClass>& classes) {
  std::set<std::string> known;
  for (const auto& [index, found] : detections)
    for (const Detection& detection : found) known.insert(detection.category);
  const auto is_known = [&](const auto& of) { return of.first == "*" || known.contains(of.first); };
  if (std::any_of(classes.begin(), classes.end(), is_known)) return;
  const std::vector<std::string_view> names(known.begin(), known.end());
  node.fail("no detection is of a class in 'classes'" +
            near_names(classes.empty() ? "" : classes.begin()->first, names) +
            "; 'names' gives numbers their names");
}

Target target_of(const DetectedClass& settings, const Detection& detection, std::size_t number) {
  Target target = settings.settings;
  RegionTarget region = settings.region;
  region.region = detection.region;
  target.shape = std::move(region);
  target.has_identity = !detection.track.empty();
  const bool is_named = detection.category == detection.track;
  target.name = target.has_identity && is_named
                    ? detection.track
                    : detection.category + (target.has_identity ? "_" + detection.track
                                                                : " " + std::to_string(number));
  if (!target.has_identity) target.handling = {};
  return target;
}

Target target_of(const TargetSource& source, std::int64_t index) {
  Target target = source.settings;
  try {
    if (source.estimate) target.estimate = source.estimate->of_frame(index);
    source.shape.set(index, target);
  } catch (const InputError& fault) {
    target.fault = fault.what();
  }
  return target;
}

}  // namespace

struct TargetsFile::State {
  std::filesystem::path file;
  std::vector<TargetSource> sources;
  Detections detections;
  std::map<std::string, DetectedClass> classes;  // "*": all others
  std::int64_t first_frame = 0;                  // of the detections
  bool is_first_given = false;
  std::vector<std::string> notes;
  double history = 0.0;

  void read_detections_of(const std::string& name, const std::filesystem::path& folder,
                          const TargetsContext& context,
                          const std::map<std::int64_t, std::string>& names) {
    if (!is_first_given) first_frame = usual_first_frame(name);
    detections = read_detections(name, folder, context.images, names, first_frame, context.stamps);
    const auto is_before = [](const auto& of) { return of.first < 0; };
    if (!is_first_given && std::ranges::any_of(detections, is_before))
      throw InputError(name + ": has detections before its first frame, " +
                       std::to_string(first_frame) +
                       ": write a targets.yaml with detections: FILE and first_frame: 0");
    if (std::string doubt = doubt_of(detections, context.images); !doubt.empty())
      notes.push_back(name + ": " + doubt);
  }
};

TargetsFile::TargetsFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
TargetsFile::~TargetsFile() = default;
TargetsFile::TargetsFile(TargetsFile&&) noexcept = default;
TargetsFile& TargetsFile::operator=(TargetsFile&&) noexcept = default;

TargetsFile TargetsFile::open(const std::filesystem::path& file, const TargetsContext& context) {
  auto state = std::make_unique<State>();
  state->file = file;
  if (is_detections_name(file)) {
    state->read_detections_of(file, {}, context, {});
    state->classes.emplace("*", class_of({}, context));
    return TargetsFile(std::move(state));
  }
  const YamlNode root = YamlNode::read(file);
  root.allow_only({"image", "history", "targets", "detections", "first_frame", "names", "classes"});
  check_image(root, context);
  if (const YamlNode* detections = root.find("detections")) {
    std::map<std::int64_t, std::string> names;
    if (const YamlNode* given = root.find("names")) names = class_names_of(*given);
    if (const YamlNode* first = root.find("first_frame")) {
      state->first_frame = first->integer();
      if (std::abs(state->first_frame) > 1'000'000'000) first->fail("is no frame of a recording");
      state->is_first_given = true;
    }
    detections->with_context(
        [&] { state->read_detections_of(detections->text(), file.parent_path(), context, names); });
    const YamlNode* const classes = root.find("classes");
    if (classes == nullptr)
      state->classes.emplace("*", class_of({}, context));
    else
      for (const YamlNode& node : classes->entries())
        state->classes.emplace(node.key(), class_of(node, context));
    check_classes(*detections, state->detections, state->classes);
    check_scores(state->detections, state->classes, state->notes);
  } else {
    for (const char* const key : {"first_frame", "names", "classes"})
      if (const YamlNode* found = root.find(key)) found->fail("is for detections; name their file");
  }
  ValueTables tables;
  std::unordered_map<std::string, std::size_t> numbers;
  const YamlNode* const targets =
      state->detections.empty() ? &root.at("targets") : root.find("targets");
  for (const YamlNode& node : targets != nullptr ? targets->items() : std::span<const YamlNode>()) {
    TargetSource& source =
        state->sources.emplace_back(source_of(node, context, file.parent_path(), tables));
    const auto [known, is_new] = numbers.emplace(source.settings.name, numbers.size());
    if (!is_new)
      node.at("name").fail("'" + source.settings.name + "' is the name of target " +
                           std::to_string(known->second + 1) + " already; use each name once");
    read_settings(node, context, source);
    if (source.shape.may_be_late) state->history = context.history;
  }
  if (const YamlNode* history = root.find("history")) {
    state->history = history->number();
    if (!(state->history >= 0.0 && state->history <= PipelineConfig::max_target_history))
      history->fail("is " + history->text() + "; 0 to 60 seconds are possible");
  }
  return TargetsFile(std::move(state));
}

std::vector<Target> TargetsFile::of_frame(std::int64_t index) const {
  std::vector<Target> targets;
  for (const TargetSource& source : state_->sources) targets.push_back(target_of(source, index));
  const auto found = state_->detections.find(index);
  if (found == state_->detections.end()) return targets;
  std::map<std::string, std::size_t> numbers;  // by class
  for (const Detection& detection : found->second) {
    const DetectedClass* const settings = class_of(detection, state_->classes);
    if (settings != nullptr && settings->takes(detection))
      targets.push_back(target_of(*settings, detection, ++numbers[detection.category]));
  }
  return targets;
}

void TargetsFile::check_frames(std::span<const std::int64_t> frames) {
  if (state_->detections.empty()) return;
  const auto lacking = [&](std::int64_t shift) {
    std::size_t count = 0;
    for (const auto& [index, found] : state_->detections)
      if (!std::ranges::binary_search(frames, index + shift)) count += found.size();
    return count;
  };
  const std::size_t missing = lacking(0);
  if (missing == 0) return;
  const auto by_number = [](const auto& a, const auto& b) { return a.first < b.first; };
  const auto [first, last] = std::ranges::minmax_element(state_->detections, by_number);
  const auto span = [](std::int64_t a, std::int64_t b) {
    return std::to_string(a) + " to " + std::to_string(b);
  };
  const std::string file = state_->file.string() + ": ";
  const std::string has = "has detections in the frames " + span(first->first, last->first);
  const std::string recording =
      ", the recording has the frames " + span(frames.front(), frames.back());
  for (const std::int64_t by : {-1, 1})
    if (!state_->is_first_given && lacking(by) == 0)
      throw InputError(file + has + recording +
                       ": write a targets.yaml with detections: FILE and " +
                       "first_frame: " + std::to_string(state_->first_frame - by) +
                       ", the file's number of frame 0 (or " + std::to_string(state_->first_frame) +
                       ", if they are right as they are)");
  if (std::ranges::none_of(state_->detections, [&](const auto& of) {
        return std::ranges::binary_search(frames, of.first);
      }))
    throw InputError(file + has + recording + "; are they of other images?");
  state_->notes.push_back(file + std::to_string(missing) +
                          " detections are of frames that do not exist: it " + has + recording);
}

const std::vector<std::string>& TargetsFile::notes() const { return state_->notes; }
const std::filesystem::path& TargetsFile::file() const { return state_->file; }
std::size_t TargetsFile::size() const { return state_->sources.size(); }
double TargetsFile::history() const { return state_->history; }

}  // namespace penumbra::io
