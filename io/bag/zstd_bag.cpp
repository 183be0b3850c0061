// SPDX-License-Identifier: Apache-2.0
// The file compression of rosbag2: a whole bag, NAME.mcap.zstd or NAME.db3.zstd.
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/mcap/compression.hpp>

namespace penumbra::io {
namespace {

/// A folder that is removed with what it holds.
class ScratchFolder {
 public:
  ScratchFolder() {
    const char* const named = std::getenv("TMPDIR");
    std::string name = named != nullptr && *named != '\0' ? named : "/var/tmp";
    name += "/penumbra-bag-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr)
      throw InputError(name + ": " + std::generic_category().message(errno));
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class ZstdBag final : public BagReader {
 public:
  explicit ZstdBag(const std::filesystem::path& file) : file_(file.string()) {
    InputFile().open(file).require();
    const ScratchFolder scratch;
    plain_ = scratch.path() / file.stem();
    std::string fault;
    try {
      fault = mcap::decompress_zstd(file, plain_);
    } catch (const InputError& error) {
      throw InputError(file_ + ": cannot be decompressed (" + error.what() +
                       "); TMPDIR names the folder for it");
    }
    if (!fault.empty()) faults_.push_back(file_ + ": " + fault + "; the part before is read");
    try {
      reader_ = open_bag_file(plain_);  // which keeps it open when its name goes
    } catch (const InputError& error) {
      throw InputError(fault.empty() ? of_file(error.what()) : file_ + ": " + fault);
    }
    take_faults();
  }

  [[nodiscard]] std::span<const BagTopic> topics() const override { return reader_->topics(); }
  [[nodiscard]] std::span<const std::string> faults() const override { return faults_; }

  bool next(BagMessage& message) override {
    const bool any = reader_->next(message);
    take_faults();
    return any;
  }

 private:
  /// Returns a message about the decompressed file as one about the file.
  [[nodiscard]] std::string of_file(std::string text) const {
    const std::string plain = plain_.string();
    return text.starts_with(plain) ? text.replace(0, plain.size(), file_) : text;
  }

  void take_faults() {
    const auto found = reader_->faults();
    for (; taken_ < found.size(); ++taken_) faults_.push_back(of_file(found[taken_]));
  }

  std::string file_;
  std::filesystem::path plain_;
  std::unique_ptr<BagReader> reader_;
  std::vector<std::string> faults_;
  std::size_t taken_ = 0;  // of the reader's faults
};

}  // namespace

std::unique_ptr<BagReader> open_zstd_bag(const std::filesystem::path& file) {
  return std::make_unique<ZstdBag>(file);
}

}  // namespace penumbra::io
