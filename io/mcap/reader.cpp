// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include <io/files/disk_file.hpp>
#include <io/mcap/chunk_merger.hpp>
#include <io/mcap/reader.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::size_t version_byte = 5;

void check_magic(const InputFile& input, const std::filesystem::path& file) {
  std::array<std::byte, magic_bytes.size()> start{};
  const std::size_t got = input.read_at(0, start.data(), start.size());
  if (got == start.size() && start == magic_bytes) return;
  const bool other_version =
      got > version_byte &&
      std::equal(start.begin(), start.begin() + version_byte, magic_bytes.begin());
  throw InputError(file.string() + (other_version
                                        ? ": is MCAP of another version; version 0 is read"
                                        : ": is not an MCAP file"));
}

}  // namespace

struct Reader::State {
  explicit State(const std::filesystem::path& file) {
    input.open(file).require();
    check_magic(input, file);
    layout = read_layout(input, faults);
    merger.emplace(input, layout, faults);
    merger->complete_definitions();
  }

  void check_count() {
    if (!layout.statistics || !faults.all().empty() || read == layout.statistics->messages) return;
    faults.add(input.size(), "the file counts " + std::to_string(layout.statistics->messages) +
                                 " messages, and " + std::to_string(read) + " were found");
  }

  InputFile input;
  FaultLog faults;
  FileLayout layout;
  std::optional<ChunkMerger> merger;
  std::set<std::uint16_t> strange;  // channels that the file does not define
  std::uint64_t read = 0;           // number of messages read
};

Reader::Reader(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

const std::string& Reader::profile() const { return state_->layout.header.profile; }
const std::string& Reader::library() const { return state_->layout.header.library; }
const std::map<std::uint16_t, Schema>& Reader::schemas() const {
  return state_->layout.definitions.schemas();
}
const std::map<std::uint16_t, Channel>& Reader::channels() const {
  return state_->layout.definitions.channels();
}
const std::optional<Statistics>& Reader::statistics() const { return state_->layout.statistics; }
const std::vector<Fault>& Reader::faults() const { return state_->faults.all(); }

bool Reader::next(Message& message) {
  while (const auto item = state_->merger->next()) {
    const MessageHead& head = item->head;
    if (!channels().contains(head.channel)) {
      if (state_->strange.insert(head.channel).second)
        state_->faults.add(item->place, "messages of channel " + std::to_string(head.channel) +
                                            ", which the file does not define, are left out");
      continue;
    }
    ++state_->read;
    message = {head.channel, head.sequence, static_cast<std::int64_t>(head.log_time),
               static_cast<std::int64_t>(head.publish_time), item->data};
    return true;
  }
  state_->check_count();
  return false;
}

}  // namespace penumbra::io::mcap
