// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>
#include <utility>

#include <io/mcap/chunk_merger.hpp>

namespace penumbra::io::mcap {
namespace {

// Finished chunks whose memory is reused.
constexpr std::size_t spare_chunks = 2;
constexpr std::size_t most_spare_bytes = std::size_t{16} << 20;  // each

}  // namespace

ChunkMerger::ChunkMerger(const InputFile& file, FileLayout& layout, FaultLog& faults)
    : loader_(file), layout_(&layout), faults_(&faults) {
  for (const MessagePlace& place : layout.places) order_.push_back(&place);
  std::stable_sort(order_.begin(), order_.end(), [](const MessagePlace* a, const MessagePlace* b) {
    return a->start_time < b->start_time;
  });
}

void ChunkMerger::complete_definitions() {
  const auto complete = [&](std::uint16_t channel) {
    return layout_->definitions.complete(channel);
  };
  for (const MessagePlace& place : layout_->places) {
    bool known = false;
    if (place.channels_known) {
      known = std::all_of(place.channels.begin(), place.channels.end(), complete);
    } else if (layout_->summary_has_channels) {
      const auto& channels = layout_->definitions.channels();
      known = std::all_of(channels.begin(), channels.end(),
                          [&](const auto& channel) { return complete(channel.first); });
    }
    if (!known) release(load(place));
  }
}

std::optional<ChunkMerger::Item> ChunkMerger::next() {
  advance();
  while (next_place_ < order_.size() &&
         (runs_.empty() || order_[next_place_]->start_time <= runs_.front().time))
    start(*order_[next_place_++]);
  if (runs_.empty()) return std::nullopt;
  std::pop_heap(runs_.begin(), runs_.end(), later);
  current_ = std::move(runs_.back());
  runs_.pop_back();
  const LoadedChunk& chunk = *current_.chunk;
  const LoadedChunk::Entry& entry = chunk.messages[current_.next];
  if (entry.log_time < last_time_)
    faults_->add(current_.place->offset,
                 "a chunk has messages from before the time at which it should begin; they come "
                 "late");
  last_time_ = std::max(last_time_, entry.log_time);
  const auto content =
      std::span<const std::byte>(chunk.records).subspan(entry.content, entry.length);
  const auto head = parse_message_head(content);
  return Item{head.value(), content.subspan(message_head_bytes), current_.place->offset};
}

bool ChunkMerger::later(const Run& a, const Run& b) {
  return std::tuple(a.time, a.place->offset) > std::tuple(b.time, b.place->offset);
}

void ChunkMerger::start(const MessagePlace& place) {
  auto chunk = load(place);
  if (chunk->messages.empty()) {
    release(std::move(chunk));
    return;
  }
  const std::uint64_t time = chunk->messages.front().log_time;
  push({&place, 0, time, std::move(chunk)});
}

void ChunkMerger::advance() {
  if (current_.place == nullptr) return;
  Run run = std::exchange(current_, {});
  if (++run.next < run.chunk->messages.size()) {
    run.time = run.chunk->messages[run.next].log_time;
    push(std::move(run));
  } else {
    release(std::move(run.chunk));
  }
}

void ChunkMerger::push(Run run) {
  runs_.push_back(std::move(run));
  std::push_heap(runs_.begin(), runs_.end(), later);
}

std::unique_ptr<LoadedChunk> ChunkMerger::load(const MessagePlace& place) {
  std::unique_ptr<LoadedChunk> chunk;
  if (spare_.empty()) {
    chunk = std::make_unique<LoadedChunk>();
  } else {
    chunk = std::move(spare_.back());
    spare_.pop_back();
  }
  loader_.load(place, *chunk, layout_->definitions, *faults_);
  return chunk;
}

void ChunkMerger::release(std::unique_ptr<LoadedChunk> chunk) {
  if (spare_.size() < spare_chunks && chunk->footprint() <= most_spare_bytes)
    spare_.push_back(std::move(chunk));
}

}  // namespace penumbra::io::mcap
