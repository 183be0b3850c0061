// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <io/json-inl.hpp>
#include <io/npy.hpp>
#include <io/png.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/scene.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t name_digits = 6;
constexpr std::array saved_kinds{Part::overlay, Part::labels, Part::links, Part::vdi};

/// What of a frame is the same each time that it is judged.
Json judged_of(const std::string& frame) {
  Json json = Json::parse(frame);
  json.erase("timing_ms");
  return json;
}

/// Throws InputError for a file that lies outside of the folder, behind a link.
void check_is_inside(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto root = std::filesystem::weakly_canonical(folder, error);
  const auto real = std::filesystem::weakly_canonical(file, error);
  const auto end = std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first;
  if (error || end != root.end())
    throw InputError(file.string() + ": leads out of the run's folder and is not shown");
}

template <typename T>
std::optional<PartBytes> bytes_of(const Image<T>& image, const FileResult& read, const char* type) {
  if (!read.ok()) return std::nullopt;
  std::string bytes(image.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), image.data(), bytes.size());
  return PartBytes{type, image.width(), image.height(), shared_bytes(std::move(bytes))};
}

std::optional<PartBytes> read_saved(const std::filesystem::path& file, Part part,
                                    const std::filesystem::path& folder) {
  check_is_inside(file, folder);
  if (part == Part::labels) {
    Image<std::uint8_t> image;
    const FileResult read = read_png(file, image);
    return bytes_of(image, read, "u8");
  }
  if (part == Part::links) {
    Image<std::uint16_t> image;
    const FileResult read = read_png(file, image);
    return bytes_of(image, read, "u16");
  }
  if (part == Part::vdi) {
    Image<float> image;
    const FileResult read = read_npy(file, image);
    return bytes_of(image, read, "f32");
  }
  Image<Rgb8> image;
  if (!read_png(file, image).ok()) return std::nullopt;
  return PartBytes{"image/png", image.width(), image.height(),
                   shared_bytes(read_whole_file(file, FileLimit::data))};
}

}  // namespace

/// One frame of a run: what was saved of it before what its input gives.
class RunFolder::SavedFrame final : public PacketFrame {
 public:
  SavedFrame(const RunFolder& folder, std::size_t i, std::unique_ptr<PacketFrame> again)
      : folder_(folder), i_(i), again_(std::move(again)) {}

  [[nodiscard]] std::string report() const override { return folder_.report_.frames[i_]; }
  [[nodiscard]] std::string poses() const override {
    return again_ ? again_->poses() : poses_json({}, {}, folder_.report_.links.size());
  }
  [[nodiscard]] std::optional<PartBytes> part(Part part) const override {
    if (folder_.is_saved(part))
      if (auto saved = read_saved(file(part), part, folder_.folder_)) return saved;
    return again_ ? again_->part(part) : std::nullopt;
  }

 private:
  [[nodiscard]] std::filesystem::path file(Part part) const {
    std::string name = std::to_string(folder_.report_.indices[i_]);
    name.insert(0, name_digits - std::min(name.size(), name_digits), '0');
    return folder_.folder_ / to_string(part) / (name + (part == Part::vdi ? ".npy" : ".png"));
  }

  const RunFolder& folder_;
  std::size_t i_;
  std::unique_ptr<PacketFrame> again_;  // null: not had, or another than the run's
};

RunFolder::RunFolder(std::filesystem::path folder, RunReport report, const FrameStore* again,
                     std::string why)
    : folder_(std::move(folder)),
      report_(std::move(report)),
      again_(again),
      why_(std::move(why)),
      is_complete_(again == nullptr) {}

bool RunFolder::is_saved(Part part) const {
  std::error_code error;
  return std::find(saved_kinds.begin(), saved_kinds.end(), part) != saved_kinds.end() &&
         std::filesystem::is_directory(folder_ / to_string(part), error);
}

std::vector<Part> RunFolder::parts() const {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < part_count; ++i) {
    const Part part = static_cast<Part>(i);
    if (again_ != nullptr || is_saved(part)) parts.push_back(part);
  }
  return parts;
}

void RunFolder::compare_next() {
  std::unique_lock lock(mutex_);
  const std::size_t i = agrees_.size();
  lock.unlock();
  const auto again = again_->frame(i);
  const bool agrees = again && i < report_.frames.size() &&
                      judged_of(again->report()) == judged_of(report_.frames[i]);
  lock.lock();
  agrees_.push_back(agrees);
  if (agrees) return;
  if (different_++ == 0) first_different_ = i;
}

void RunFolder::finish(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    why_ = why;
  }
  is_complete_ = true;
}

std::size_t RunFolder::size() const {
  const std::lock_guard lock(mutex_);
  return is_complete_ ? report_.frames.size() : std::min(agrees_.size(), report_.frames.size());
}

SharedBytes RunFolder::report(std::size_t from) const {
  const bool is_whole = is_complete_;
  const std::size_t count = size();
  std::string text = report_.start;
  for (std::size_t i = from; i < count; ++i) text += (i == from ? "\n" : ",\n") + report_.frames[i];
  return shared_bytes(text + (is_whole ? report_.end : unfinished_report_end()));
}

std::unique_ptr<PacketFrame> RunFolder::frame(std::size_t i) const {
  if (i >= size()) return nullptr;
  const std::lock_guard lock(mutex_);
  const bool agrees = i < agrees_.size() && agrees_[i];
  return std::make_unique<SavedFrame>(*this, i, agrees ? again_->frame(i) : nullptr);
}

/// The images that neither were saved nor can be had from the input.
std::string RunFolder::lacking() const {
  std::string names = "color, depth, cloud, robot";
  for (const Part part : saved_kinds)
    if (!is_saved(part)) names += ", " + std::string(to_string(part));
  return names;
}

std::vector<std::string> RunFolder::missing() const {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  if (different_ > 0)
    lines.push_back(lacking() + " of " + std::to_string(different_) + " of " +
                    std::to_string(agrees_.size()) + " frames: the input, judged again, gives " +
                    "something else than this report, first in its frame " +
                    std::to_string(first_different_) + "; penumbra run " + report_.input + " -o " +
                    folder_.string() + " judges it anew");
  if (is_complete_ && again_ != nullptr && agrees_.size() < report_.frames.size())
    lines.push_back(lacking() + " of the frames from " + std::to_string(agrees_.size()) + " on: " +
                    (why_.empty() ? "the input has fewer frames than this report" : why_));
  else if (!why_.empty())
    lines.push_back(lacking() + ": " + why_);
  return lines;
}

}  // namespace penumbra::io
