// SPDX-License-Identifier: Apache-2.0
// COCO's results: https://cocodataset.org/#format-results; MOT: https://arxiv.org/abs/1603.00831;
// YOLO: https://docs.ultralytics.com/datasets/detect (with save_conf and track ids behind).
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/coco_mask.hpp>
#include <io/files/csv.hpp>
#include <io/files/detections_file.hpp>
#include <io/files/frame_pattern.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint64_t most_json_bytes = FileLimit::data / 4;  // it takes several times as much
constexpr std::size_t most_in_frame = 4096;
constexpr double fraction_rounding = 1e-3;  // of YOLO's fractions
constexpr std::int64_t last_frame = 1'000'000'000'000'000;

using ClassNames = std::map<std::int64_t, std::string>;

std::string name_of(std::int64_t number, const ClassNames& names) {
  const auto found = names.find(number);
  return found != names.end() ? found->second : std::to_string(number);
}

/// Detectors count from the edge of the first pixel, regions from its centre.
PixelBox box_of(double x, double y, double width, double height) {
  return {x - 0.5, y - 0.5, width, height};
}

std::optional<double> score_of(double number) {
  return number == -1.0 ? std::nullopt : std::optional(number);  // -1: none, as in MOT's files
}

std::string track_of(std::string_view text) {
  return text == "-1" || text == "null" ? "" : std::string(text);
}

/// Returns the last number in a text: of "frame_000012.png" 12.
std::optional<std::int64_t> last_number(std::string_view text) {
  constexpr std::string_view digits = "0123456789";
  const std::size_t end = text.find_last_of(digits);
  if (end == std::string_view::npos) return std::nullopt;
  const std::size_t before = text.find_last_not_of(digits, end);
  const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
  return parse_number<std::int64_t>(text.substr(first, end + 1 - first));
}

// COCO

Region coco_region(const nlohmann::json& entry, const Intrinsics& images) {
  if (const auto mask = entry.find("segmentation"); mask != entry.end() && mask->is_object()) {
    const auto& counts = mask->at("counts");
    const auto size = mask->at("size").get<std::vector<int>>();
    if (size != std::vector<int>{images.height(), images.width()})
      throw InputError("has a mask of another size; expected [" + std::to_string(images.height()) +
                       ", " + std::to_string(images.width()) + "] (height, width)");
    auto runs = counts.is_string() ? decoded_counts(counts.get<std::string>())
                                   : counts.get<std::vector<std::uint32_t>>();
    if (!runs) throw InputError("has damaged run lengths");
    return RunLengthMask{images.width(), images.height(), *std::move(runs)};
  }
  if (!entry.contains("bbox")) throw InputError("has neither a bbox nor a mask of run lengths");
  const auto box = entry.at("bbox").get<std::vector<double>>();
  if (box.size() != 4) throw InputError("has a bbox that is not [x, y, width, height]");
  return box_of(box[0], box[1], box[2], box[3]);
}

/// An image of a data set.
struct CocoImage {
  std::int64_t frame = 0;
  std::array<std::int64_t, 2> size{};  // width and height; 0: not known
};
using CocoImages = std::map<std::string, CocoImage>;  // by image_id

std::string key_of(const nlohmann::json& id) {
  return id.is_string() ? id.get<std::string>() : id.dump();
}

CocoImages coco_images(const nlohmann::json& list) {
  CocoImages images;
  for (const nlohmann::json& image : list)
    if (const auto number = last_number(image.at("file_name").get<std::string>()))
      images.emplace(key_of(image.at("id")), CocoImage{*number,
                                                       {image.value("width", std::int64_t{0}),
                                                        image.value("height", std::int64_t{0})}});
  return images;
}

std::int64_t coco_frame(const nlohmann::json& id, const CocoImages& images,
                        const Intrinsics& camera) {
  const std::string key = key_of(id);
  if (const auto named = images.find(key); named != images.end()) {
    const auto [width, height] = named->second.size;
    if (width > 0 && height > 0 && (width != camera.width() || height != camera.height()))
      throw InputError("is of an image of " + std::to_string(width) + " x " +
                       std::to_string(height) + "; expected boxes in the camera's image of " +
                       std::to_string(camera.width()) + " x " + std::to_string(camera.height()));
    return named->second.frame;
  }
  if (const auto number = last_number(key)) return *number;
  throw InputError("has the image_id " + key + ", which holds no frame's number");
}

Detections read_coco(const std::filesystem::path& file, const Intrinsics& images,
                     ClassNames names) {
  const auto root = nlohmann::json::parse(read_whole_file(file, most_json_bytes));
  CocoImages frames;
  if (root.is_object() && root.contains("shapes") && !root.contains("annotations"))
    throw InputError(
        "is LabelMe's file of one image, which is not read; export COCO, or write a table with "
        "the header frame,class,x0,y0,x1,y1");
  if (root.is_object()) {  // a data set
    for (const nlohmann::json& category : root.value("categories", nlohmann::json::array()))
      names.emplace(category.at("id").get<std::int64_t>(), category.at("name").get<std::string>());
    frames = coco_images(root.at("images"));
  }
  Detections all;
  std::size_t number = 0;
  for (const nlohmann::json& entry : root.is_object() ? root.at("annotations") : root) {
    try {
      Detection& found = all[coco_frame(entry.at("image_id"), frames, images)].emplace_back(
          Detection{.category = name_of(entry.at("category_id").get<std::int64_t>(), names),
                    .track = {},
                    .region = coco_region(entry, images),
                    .score = score_of(entry.value("score", -1.0))});
      if (const auto track = entry.find("track_id"); track != entry.end())
        found.track = track_of(track->is_string() ? track->get<std::string>() : track->dump());
    } catch (const std::exception& error) {
      throw InputError("detection " + std::to_string(number) + " " + error.what());
    }
    ++number;
  }
  return all;
}

// Tables

Detections read_table(const std::filesystem::path& file, const ClassNames& names) {
  const FrameTable table(file);
  const std::string form =
      "the header must be frame and, in any order, [name|track,][class,]x0,y0,x1,y1[,score]";
  std::array<std::size_t, 4> corners{};
  constexpr std::array<std::string_view, 4> corner_names{"x0", "y0", "x1", "y1"};
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = table.at(corner_names[i], form);
  const auto name = table.find("name"), track = table.find("track"), category = table.find("class"),
             score = table.find("score");
  Detections all;
  for (const FrameTable::Row& row : table.rows()) {
    try {
      table.check_width(row);
      std::array<double, 4> at{};
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = table.number<double>(row, corners[i]);
      Detection found{.category = {},
                      .track = {},
                      .region = box_of(at[0], at[1], at[2] - at[0], at[3] - at[1])};
      if (category) found.category = row.cells[*category];
      if (const auto number = parse_number<std::int64_t>(found.category))
        found.category = name_of(*number, names);
      if (track) found.track = track_of(row.cells[*track]);
      if (name) found.track = row.cells[*name];
      if (name && !category) found.category = found.track;
      if (score) found.score = score_of(table.number<double>(row, *score));
      all[row.frame].push_back(std::move(found));
    } catch (const InputError& fault) {
      throw InputError(table.place(row.line) + fault.what());
    }
  }
  return all;
}

/// Calls `take` with the numbers of each line, separated by commas or spaces.
template <typename Take>
void for_each_line(const std::filesystem::path& file, const Take& take) {
  std::string text = read_csv(file);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t'; }, ',');
  CsvLines lines(text, file);
  while (lines.next()) {
    std::vector<double> numbers;
    for (const std::string_view cell : lines.cells()) {
      if (cell.empty()) continue;
      const auto number = parse_number<double>(cell);
      const std::string place = file.string() + ":" + std::to_string(lines.line()) + ": ";
      if (!number) throw InputError(place + "'" + std::string(cell) + "' is no number");
      numbers.push_back(*number);
    }
    try {
      if (!numbers.empty()) take(numbers);
    } catch (const InputError& fault) {
      throw InputError(file.string() + ":" + std::to_string(lines.line()) + ": " + fault.what());
    }
  }
}

std::int64_t whole(double number) {
  if (!(std::abs(number) < 1e15 && number == std::floor(number)))
    throw InputError("has " + std::to_string(number) + ", which is not an integer");
  return static_cast<std::int64_t>(number);
}

Detections read_mot(const std::filesystem::path& file, const ClassNames& names) {
  Detections all;
  for_each_line(file, [&](const std::vector<double>& n) {
    if (n.size() < 6 || n.size() > 10)
      throw InputError(
          "has " + std::to_string(n.size()) +
          " numbers; expected MOT's frame, track, x, y, width, height[, score[, class, "
          "...]]");
    Detection found{.category = "object", .track = {}, .region = box_of(n[2], n[3], n[4], n[5])};
    if (n[1] >= 0) found.track = std::to_string(whole(n[1]));
    if (n.size() > 6) found.score = score_of(n[6]);
    // Files of ground truth and of several classes have the class here, others -1 or a position.
    if (n.size() > 7 && n.size() < 10) found.category = name_of(whole(n[7]), names);
    all[whole(n[0])].push_back(std::move(found));
  });
  return all;
}

/// The sixth number is the score or, where scores were not saved, the track: a whole number from 1.
Detections read_yolo(const FramePattern& files, const Intrinsics& images, const ClassNames& names) {
  Detections all;
  double most = 1.0;
  bool are_whole = true;
  for (const std::int64_t index : files.existing())
    for_each_line(files.file(index), [&](const std::vector<double>& n) {
      if (n.size() < 5 || n.size() > 7)
        throw InputError("has " + std::to_string(n.size()) +
                         " numbers; expected YOLO's class, x, y, width, height[, score[, track]]");
      if (std::any_of(n.begin() + 1, n.begin() + 5,
                      [](double x) { return x < -fraction_rounding || x > 1 + fraction_rounding; }))
        throw InputError("has a box outside of 0 to 1; YOLO's boxes are in fractions of the image");
      const double width = n[3] * images.width(), height = n[4] * images.height();
      Detection found{.category = name_of(whole(n[0]), names),
                      .track = {},
                      .region = box_of(n[1] * images.width() - 0.5 * width,
                                       n[2] * images.height() - 0.5 * height, width, height)};
      if (n.size() > 5) found.score = score_of(n[5]);
      if (n.size() > 6) found.track = std::to_string(whole(n[6]));
      if (n.size() == 6) most = std::max(most, n[5]);
      if (n.size() != 5 && (n.size() == 7 || n[5] != std::floor(n[5]))) are_whole = false;
      all[index].push_back(std::move(found));
    });
  if (!are_whole || most == 1.0) return all;
  for (auto& [index, found] : all)
    for (Detection& detection : found)
      if (const auto track = std::exchange(detection.score, {}))
        detection.track = std::to_string(whole(*track));
  return all;
}

Detections read_any(const std::string& name, const std::filesystem::path& folder,
                    const Intrinsics& images, const ClassNames& names,
                    const std::optional<FrameStamps>& stamps) {
  if (name.find('%') != std::string::npos) {
    const FramePattern files(name, folder, stamps);
    if (files.existing().empty()) throw InputError(name + ": no file of that name for any frame");
    return read_yolo(files, images, names);
  }
  const std::filesystem::path file = folder / name;
  const std::string ending = file.extension().string();
  if (ending == ".csv") return read_table(file, names);
  if (ending == ".txt") return read_mot(file, names);
  if (ending != ".json")
    throw InputError(
        file.string() +
        ": is no detector's file; COCO results (.json), a table (.csv), MOT (.txt) and "
        "YOLO (labels/%d.txt) are read");
  try {
    return read_coco(file, images, names);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": is no JSON of COCO results: " + error.what());
  } catch (const InputError& error) {
    const std::string text = error.what();
    throw InputError(text.starts_with(file.string()) ? text : file.string() + ": " + text);
  }
}

/// Refuses what no detector means.
void check(const std::string& file, const Detections& all) {
  bool is_fraction = true;
  for (const auto& [index, found] : all) {
    const std::string frame = file + ": frame " + std::to_string(index) + " ";
    if (found.size() > most_in_frame)
      throw InputError(frame + "has " + std::to_string(found.size()) + " detections; at most " +
                       std::to_string(most_in_frame) +
                       " are read: raise the detector's minimum score");
    if (std::abs(index) > last_frame) throw InputError(frame + "is no frame of a recording");
    std::set<std::pair<std::string_view, std::string_view>> tracks;
    for (const Detection& one : found) {
      if (!one.category.empty()) check_name(one.category);
      if (!one.track.empty()) check_name(one.track);
      if (!one.track.empty() && !tracks.emplace(one.category, one.track).second)
        throw InputError(frame + "has the track '" + one.track +
                         "' twice; expected one box of each track (name and track are of one "
                         "object; a column of classes is called class)");
      const auto* const box = std::get_if<PixelBox>(&one.region);
      is_fraction = is_fraction && box != nullptr && box->u + box->width <= 0.5 &&
                    box->v + box->height <= 0.5;
    }
  }
  if (is_fraction)
    throw InputError(file +
                     ": all boxes lie within the first pixel: they are in fractions of the "
                     "image; expected pixels");
}

}  // namespace

Detections read_detections(const std::string& file_or_pattern, const std::filesystem::path& folder,
                           const Intrinsics& images,
                           const std::map<std::int64_t, std::string>& names,
                           std::int64_t first_frame, const std::optional<FrameStamps>& stamps) {
  Detections read = read_any(file_or_pattern, folder, images, names, stamps);
  if (read.empty()) throw InputError(file_or_pattern + ": holds no detection");
  check(file_or_pattern, read);
  if (first_frame == 0) return read;
  Detections all;
  for (auto& [index, found] : read) all.emplace(index - first_frame, std::move(found));
  return all;
}

std::int64_t usual_first_frame(const std::string& file_or_pattern) {
  return file_or_pattern.ends_with(".txt") && file_or_pattern.find('%') == std::string::npos ? 1
                                                                                             : 0;
}

std::string doubt_of(const Detections& all, const Intrinsics& images) {
  constexpr double much =
      0.1;  // of the image; boxes that are predicted whole may end a bit outside
  const double width = images.width(), height = images.height();
  std::size_t boxes = 0, outside = 0, corners = 0;
  for (const auto& [index, found] : all)
    for (const Detection& one : found) {
      const auto* const box = std::get_if<PixelBox>(&one.region);
      if (box == nullptr) continue;
      const double right = box->u + box->width, bottom = box->v + box->height;
      ++boxes;
      outside += box->u < -much * width || box->v < -much * height || right > (1 + much) * width ||
                 bottom > (1 + much) * height;
      corners += box->width > box->u && box->height > box->v && box->width <= width &&
                 box->height <= height;
    }
  if (outside == 0 || (2 * outside <= boxes && corners < boxes)) return {};
  return std::to_string(outside) + " of " + std::to_string(boxes) +
         " boxes end outside of the image of " + std::to_string(images.width()) + " x " +
         std::to_string(images.height()) + ": are they of another size of the image" +
         (corners == boxes ? ", or x0, y0, x1, y1 in place of x, y, width, height?" : "?");
}

bool is_detections_name(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".json" || ending == ".csv" || ending == ".txt";
}

}  // namespace penumbra::io
