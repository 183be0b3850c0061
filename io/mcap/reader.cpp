// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/mcap/compression.hpp>
#include <io/mcap/file_index.hpp>
#include <io/mcap/reader.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::uint64_t latest_time = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t version_byte = 5;
constexpr std::size_t most_kept = std::size_t{64} << 20;     // bytes that are reused
constexpr std::uint64_t most_held = std::uint64_t{2} << 30;  // bytes of overlapping chunks

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

// A chunk in memory, or a range of records outside of chunks, and the next of its messages.
struct LoadedChunk {
  struct Entry {
    std::uint64_t log_time = 0;
    std::uint64_t content = 0;  // offset of the message's content in `records`
    std::uint64_t length = 0;   // of the content
  };

  const MessagePlace* place = nullptr;
  std::vector<std::byte> records;
  std::vector<Entry> messages;  // by log time, then in the file's order
  std::size_t next = 0;

  [[nodiscard]] const Entry& entry() const { return messages[next]; }
  [[nodiscard]] std::span<const std::byte> content() const {
    return std::span<const std::byte>(records).subspan(entry().content, entry().length);
  }
};
using LoadedChunks = std::vector<std::unique_ptr<LoadedChunk>>;

bool is_later(const std::unique_ptr<LoadedChunk>& a, const std::unique_ptr<LoadedChunk>& b) {
  return std::tuple(a->entry().log_time, a->place->offset) >
         std::tuple(b->entry().log_time, b->place->offset);
}

struct Reader::State {
  explicit State(const std::filesystem::path& file) : name(file.string()) {
    input.open(file).require();
    check_magic(input, file);
    index = read_index(input, faults);
    for (const MessagePlace& place : index.places) {
      order.push_back(&place);
      if (index.may_define(place)) release(load(place));
    }
    std::stable_sort(order.begin(), order.end(), [](const MessagePlace* a, const MessagePlace* b) {
      return a->start_time < b->start_time;
    });
  }

  // Goes to the next message by log time: the one of `current`.
  bool advance();
  void push(std::unique_ptr<LoadedChunk> chunk);
  void release(std::unique_ptr<LoadedChunk> chunk) {
    held -= chunk->records.size();
    if (chunk->records.capacity() <= most_kept) spare = std::move(chunk);
  }

  // Reads a place and adds its schemas and channels to the index. A damaged chunk gives no
  // messages; a chunk with damaged records gives the messages before the damage.
  std::unique_ptr<LoadedChunk> load(const MessagePlace& place);
  std::string load_records(const MessagePlace& place, std::vector<std::byte>& records);
  bool read(std::uint64_t offset, std::uint64_t count, std::vector<std::byte>& to) const;
  void take_records(LoadedChunk& chunk);
  void take_message(LoadedChunk& chunk, std::span<const std::byte> content);
  void check_count();

  std::string name;
  InputFile input;
  FaultLog faults;
  FileIndex index;
  std::vector<const MessagePlace*> order;  // by start time
  std::size_t next_place = 0;
  LoadedChunks open;                     // a heap with the earliest message first
  std::unique_ptr<LoadedChunk> current;  // of the last returned message
  std::unique_ptr<LoadedChunk> spare;    // whose memory is reused
  std::uint64_t held = 0;                // bytes of chunks in memory but for `spare`
  std::uint64_t last_time = 0;
  Decompressor decompressor;
  std::vector<std::byte> compressed;
  std::set<std::uint16_t> undefined;  // channels that were reported
  std::uint64_t messages = 0;         // read so far
};

bool Reader::State::advance() {
  if (current) {
    ++current->next;
    push(std::move(current));
  }
  while (next_place < order.size() &&
         (open.empty() || order[next_place]->start_time <= open.front()->entry().log_time))
    push(load(*order[next_place++]));
  if (open.empty()) return false;
  std::pop_heap(open.begin(), open.end(), is_later);
  current = std::move(open.back());
  open.pop_back();
  const std::uint64_t time = current->entry().log_time;
  if (time < last_time)
    faults.add(current->place->offset,
               "a chunk has messages from before the time at which it should begin; they come "
               "late");
  last_time = std::max(last_time, time);
  return true;
}

void Reader::State::push(std::unique_ptr<LoadedChunk> chunk) {
  if (chunk->next == chunk->messages.size()) return release(std::move(chunk));
  open.push_back(std::move(chunk));
  std::push_heap(open.begin(), open.end(), is_later);
}

std::unique_ptr<LoadedChunk> Reader::State::load(const MessagePlace& place) {
  auto chunk = spare ? std::move(spare) : std::make_unique<LoadedChunk>();
  chunk->place = &place;
  chunk->messages.clear();
  chunk->next = 0;
  const std::string fault = load_records(place, chunk->records);
  held += chunk->records.size();
  if (held > most_held)
    throw InputError(name +
                     ": its chunks overlap in time, and more than 2 GiB of them would be held in "
                     "memory; sort its messages by time: mcap sort");
  if (compressed.capacity() > most_kept) compressed = {};
  if (!fault.empty()) {
    faults.add(place.offset, fault + "; its messages are left out");
    return chunk;
  }
  take_records(*chunk);
  std::stable_sort(chunk->messages.begin(), chunk->messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  return chunk;
}

std::string Reader::State::load_records(const MessagePlace& place,
                                        std::vector<std::byte>& records) {
  constexpr const char* cut = "a chunk cannot be read to its end (was the file cut meanwhile?)";
  if (place.loose) return read(place.offset, place.length, records) ? std::string() : cut;
  if (place.length > max_record_bytes + record_head_bytes)
    return "a chunk claims " + std::to_string(place.length) + " bytes, more than any may have";

  std::array<std::byte, record_head_bytes + ChunkHead::most_bytes> start{};
  const std::size_t got =
      input.read_at(place.offset, start.data(), std::min<std::size_t>(start.size(), place.length));
  if (got < record_head_bytes) return cut;
  RecordParser parser(std::span<const std::byte>(start).first(got));
  const RecordHead head = parser.head();
  if (head.opcode != Opcode::chunk || head.length != place.length - record_head_bytes)
    return "there is no chunk of " + std::to_string(place.length) + " bytes as the index says";
  const auto chunk = parse<ChunkHead>(parser.rest());
  if (!chunk || chunk->records_size > head.length - chunk->records_offset())
    return "a chunk's head is damaged";

  const std::uint64_t at = place.offset + record_head_bytes + chunk->records_offset();
  const bool is_packed = !chunk->compression.empty();
  if (!is_packed && chunk->uncompressed_size != chunk->records_size)
    return "an uncompressed chunk has two different sizes";
  if (!read(at, chunk->records_size, is_packed ? compressed : records)) return cut;
  if (is_packed) {
    const std::string fault =
        decompressor.decompress(chunk->compression, compressed, chunk->uncompressed_size, records);
    if (!fault.empty()) return "a chunk " + fault;
  }
  if (chunk->uncompressed_crc != 0 && crc32(records) != chunk->uncompressed_crc)
    return "a chunk has a wrong checksum";
  return {};
}

bool Reader::State::read(std::uint64_t offset, std::uint64_t count,
                         std::vector<std::byte>& to) const {
  if (offset > input.size() || count > input.size() - offset) return false;
  to.resize(count);
  return input.read_at(offset, to.data(), count) == count;
}

// Reads a chunk's records up to the first damaged one.
void Reader::State::take_records(LoadedChunk& chunk) {
  const std::uint64_t place = chunk.place->offset;
  RecordParser parser(chunk.records);
  while (!parser.rest().empty()) {
    const std::size_t at = chunk.records.size() - parser.rest().size();
    const RecordHead head = parser.head();
    const auto content = parser.bytes(head.length);
    if (!parser.ok() || head.opcode == Opcode{0})
      return faults.add(place, "a chunk's records are damaged at byte " + std::to_string(at) +
                                   " of " + std::to_string(chunk.records.size()) +
                                   "; those from there on are left out");
    if (head.opcode == Opcode::message)
      take_message(chunk, content);
    else if (head.opcode == Opcode::schema || head.opcode == Opcode::channel)
      index.define(head.opcode, content, place, faults);
    else if (head.opcode <= Opcode::data_end)  // others are of a later version
      faults.add(place, "a chunk holds records that no chunk may hold; left out");
  }
}

void Reader::State::take_message(LoadedChunk& chunk, std::span<const std::byte> content) {
  const auto message = parse<MessageHead>(content);
  if (!message)
    return faults.add(chunk.place->offset, "a message is shorter than its head; left out");
  if (std::max(message->log_time, message->publish_time) > latest_time)
    return faults.add(chunk.place->offset, "messages with times after the year 2262 are left out");
  chunk.messages.push_back({message->log_time,
                            static_cast<std::uint64_t>(content.data() - chunk.records.data()),
                            content.size()});
}

void Reader::State::check_count() {
  if (!index.statistics || !faults.all().empty() || messages == index.statistics->messages) return;
  faults.add(input.size(), "the file counts " + std::to_string(index.statistics->messages) +
                               " messages, and " + std::to_string(messages) + " were found");
}

Reader::Reader(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {}
Reader::~Reader() = default;

const std::string& Reader::profile() const { return state_->index.header.profile; }
const std::string& Reader::library() const { return state_->index.header.library; }
const std::map<std::uint16_t, Schema>& Reader::schemas() const { return state_->index.schemas; }
const std::map<std::uint16_t, Channel>& Reader::channels() const { return state_->index.channels; }
const std::optional<Statistics>& Reader::statistics() const { return state_->index.statistics; }
const std::vector<Fault>& Reader::faults() const { return state_->faults.all(); }

bool Reader::next(Message& message) {
  State& s = *state_;
  while (s.advance()) {
    const auto content = s.current->content();
    const MessageHead head = parse<MessageHead>(content).value();
    if (channels().contains(head.channel)) {
      ++s.messages;
      message = {head.channel, head.sequence, static_cast<std::int64_t>(head.log_time),
                 static_cast<std::int64_t>(head.publish_time), content.subspan(message_head_bytes)};
      return true;
    }
    if (s.undefined.insert(head.channel).second)
      s.faults.add(s.current->place->offset, "messages of channel " + std::to_string(head.channel) +
                                                 ", which the file does not define, are left out");
  }
  s.check_count();
  return false;
}

}  // namespace penumbra::io::mcap
