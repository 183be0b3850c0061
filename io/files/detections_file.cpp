// SPDX-License-Identifier: Apache-2.0
// COCO's results: https://cocodataset.org/#format-results; MOT: https://arxiv.org/abs/1603.00831;
// YOLO: https://docs.ultralytics.com/datasets/detect (with save_conf and track ids behind).
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/csv.hpp>
#include <io/files/detections_file.hpp>
#include <io/files/frame_pattern.hpp>
#include <io/files/names.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint64_t most_json_bytes = FileLimit::data / 4;  // it takes several times as much

using ClassNames = std::map<std::int64_t, std::string>;

std::string name_of(std::int64_t number, const ClassNames& names) {
  const auto found = names.find(number);
  return found != names.end() ? found->second : std::to_string(number);
}

/// Detectors count from the edge of the first pixel, regions from its centre.
PixelBox box_of(double x, double y, double width, double height) {
  return {x - 0.5, y - 0.5, width, height};
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

/// Decodes the text form of run lengths: six bits a letter, as differences to the last but one.
std::vector<std::uint32_t> runs_of(const std::string& text) {
  std::vector<std::int64_t> runs;
  for (std::size_t i = 0; i < text.size();) {
    std::int64_t value = 0;
    for (unsigned shift = 0, letter = 0x20; (letter & 0x20U) != 0; shift += 5) {
      if (i >= text.size() || shift > 30) throw InputError("has damaged run lengths");
      letter = static_cast<unsigned char>(text[i++]) - 48U;
      value |= static_cast<std::int64_t>(letter & 0x1FU) << shift;
      const bool is_last = (letter & 0x20U) == 0;
      if (is_last && (letter & 0x10U) != 0) value -= std::int64_t{1} << (shift + 5);
    }
    if (runs.size() > 2) value += runs[runs.size() - 2];
    runs.push_back(value);
  }
  std::vector<std::uint32_t> counts;
  for (const std::int64_t run : runs) {
    if (run < 0 || run > std::numeric_limits<std::uint32_t>::max())
      throw InputError("has damaged run lengths");
    counts.push_back(static_cast<std::uint32_t>(run));
  }
  return counts;
}

Region coco_region(const nlohmann::json& entry, const Intrinsics& images) {
  if (const auto mask = entry.find("segmentation"); mask != entry.end() && mask->is_object()) {
    const auto& counts = mask->at("counts");
    const auto size = mask->at("size").get<std::vector<int>>();
    if (size != std::vector<int>{images.height(), images.width()})
      throw InputError("has a mask of another size; expected [" + std::to_string(images.height()) +
                       ", " + std::to_string(images.width()) + "] (height, width)");
    return RunLengthMask{images.width(), images.height(),
                         counts.is_string() ? runs_of(counts.get<std::string>())
                                            : counts.get<std::vector<std::uint32_t>>()};
  }
  if (!entry.contains("bbox")) throw InputError("has neither a bbox nor a mask of run lengths");
  const auto box = entry.at("bbox").get<std::vector<double>>();
  if (box.size() != 4) throw InputError("has a bbox that is not [x, y, width, height]");
  return box_of(box[0], box[1], box[2], box[3]);
}

std::int64_t coco_frame(const nlohmann::json& id,
                        const std::map<std::string, std::int64_t>& frames) {
  const std::string key = id.is_string() ? id.get<std::string>() : id.dump();
  if (const auto named = frames.find(key); named != frames.end()) return named->second;
  if (const auto number = last_number(key)) return *number;
  throw InputError("has the image_id " + key + ", which holds no frame's number");
}

Detections read_coco(const std::filesystem::path& file, const Intrinsics& images,
                     ClassNames names) {
  const auto root = nlohmann::json::parse(read_whole_file(file, most_json_bytes));
  std::map<std::string, std::int64_t> frames;  // by image_id
  if (root.is_object() && root.contains("shapes") && !root.contains("annotations"))
    throw InputError(
        "is LabelMe's file of one image, which is not read; export COCO, or write a table with "
        "the header frame,class,x0,y0,x1,y1");
  if (root.is_object()) {  // a data set
    for (const nlohmann::json& category : root.value("categories", nlohmann::json::array()))
      names.emplace(category.at("id").get<std::int64_t>(), category.at("name").get<std::string>());
    for (const nlohmann::json& image : root.at("images"))
      if (const auto number = last_number(image.at("file_name").get<std::string>()))
        frames.emplace(image.at("id").dump(), *number);
  }
  Detections all;
  std::size_t number = 0;
  for (const nlohmann::json& entry : root.is_object() ? root.at("annotations") : root) {
    try {
      Detection& found = all[coco_frame(entry.at("image_id"), frames)].emplace_back(
          Detection{.category = name_of(entry.at("category_id").get<std::int64_t>(), names),
                    .track = {},
                    .region = coco_region(entry, images),
                    .score = entry.value("score", 1.0)});
      if (const auto track = entry.find("track_id"); track != entry.end())
        found.track = track->is_string() ? track->get<std::string>() : track->dump();
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
      if (track) found.track = row.cells[*track];
      if (name) found.track = row.cells[*name];
      if (name && !category) found.category = found.track;
      if (score) found.score = table.number<double>(row, *score);
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
  CsvLines lines(text);
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
    if (n[0] < 1) throw InputError("has the frame 0; the first frame of MOT is 1: add 1 to all");
    Detection found{.category = "object", .track = {}, .region = box_of(n[2], n[3], n[4], n[5])};
    if (n[1] >= 0) found.track = std::to_string(whole(n[1]));
    if (n.size() > 6) found.score = n[6];
    // Files of ground truth and of several classes have the class here, others -1 or a position.
    if (n.size() > 7 && n.size() < 10) found.category = name_of(whole(n[7]), names);
    all[whole(n[0]) - 1].push_back(std::move(found));  // the first frame is 1
  });
  return all;
}

Detections read_yolo(const FramePattern& files, const Intrinsics& images, const ClassNames& names) {
  Detections all;
  for (const std::int64_t index : files.existing())
    for_each_line(files.file(index), [&](const std::vector<double>& n) {
      if (n.size() < 5 || n.size() > 7)
        throw InputError("has " + std::to_string(n.size()) +
                         " numbers; expected YOLO's class, x, y, width, height[, score[, track]]");
      if (n[1] < 0 || n[1] > 1 || n[2] < 0 || n[2] > 1)
        throw InputError("has a centre outside of 0 to 1; YOLO's boxes are in shares of the image");
      const double width = n[3] * images.width(), height = n[4] * images.height();
      Detection found{.category = name_of(whole(n[0]), names),
                      .track = {},
                      .region = box_of(n[1] * images.width() - 0.5 * width,
                                       n[2] * images.height() - 0.5 * height, width, height)};
      if (n.size() > 5) found.score = n[5];
      if (n.size() > 6) found.track = std::to_string(whole(n[6]));
      all[index].push_back(std::move(found));
    });
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

}  // namespace

Detections read_detections(const std::string& file_or_pattern, const std::filesystem::path& folder,
                           const Intrinsics& images,
                           const std::map<std::int64_t, std::string>& names,
                           const std::optional<FrameStamps>& stamps) {
  Detections all = read_any(file_or_pattern, folder, images, names, stamps);
  if (all.empty()) throw InputError(file_or_pattern + ": holds no detection");
  for (const auto& [index, found] : all)
    for (const Detection& detection : found) {
      if (!detection.category.empty()) check_name(detection.category);
      if (!detection.track.empty()) check_name(detection.track);
    }
  return all;
}

bool is_detections_name(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".json" || ending == ".csv" || ending == ".txt";
}

}  // namespace penumbra::io
