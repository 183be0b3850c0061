// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/mcap/data_walk.hpp>
#include <io/mcap/file_layout.hpp>
#include <io/mcap/file_summary.hpp>

namespace penumbra::io::mcap {
namespace {

// Reads the header and returns the offset after it.
std::uint64_t read_header(FileWindow& window, HeaderRecord& header, FaultLog& faults) {
  const std::uint64_t at = magic_bytes.size();
  const auto bytes = window.view(at, record_head_bytes);
  if (bytes.size() == record_head_bytes) {
    const RecordHead head = parse_head(bytes);
    const std::uint64_t content_at = at + record_head_bytes;
    if (head.opcode == Opcode::header && head.length <= window.file_size() - content_at &&
        head.length <= max_definition_bytes) {
      auto read = parse_header(window.view(content_at, static_cast<std::size_t>(head.length)));
      if (read) header = std::move(*read);
      if (!read) faults.add(at, "the file's header is damaged; profile and library are not known");
      return content_at + head.length;
    }
  }
  faults.add(at, "the file has no header; profile and library are not known");
  return at;
}

// Walks through the ranges between indexed chunks, which may hold messages that are not in the
// index.
void walk_between(DataWalk& walk, FileSummary& summary, std::uint64_t begin, FileLayout& layout) {
  for (ChunkIndexRecord& chunk : summary.chunks) {
    walk.run(begin, chunk.offset);
    MessagePlace& place = layout.places.emplace_back();
    place.offset = chunk.offset;
    place.length = chunk.length;
    place.start_time = chunk.start_time;
    place.channels_known = !chunk.channels.empty();
    place.channels = std::move(chunk.channels);
    begin = chunk.offset + chunk.length + chunk.message_index_length;
  }
  walk.run(begin, summary.start);
}

}  // namespace

FileLayout read_layout(const InputFile& file, FaultLog& faults) {
  FileLayout layout;
  FileWindow window(file);
  const std::uint64_t begin = read_header(window, layout.header, faults);
  const auto footer = read_footer(window);
  auto summary = footer ? read_summary(window, *footer, begin, faults) : std::nullopt;

  const bool has_summary = summary.has_value();
  DataWalk walk(window, layout, faults);
  if (summary) {
    layout.definitions = std::move(summary->definitions);
    layout.statistics = std::move(summary->statistics);
    layout.summary_has_channels = !layout.definitions.channels().empty();
    walk_between(walk, *summary, begin, layout);
  } else {
    walk.run(begin, file.size());
  }

  if (!walk.has_end() && !walk.damaged() && !has_summary)
    faults.add(file.size(), "the data has no end (was the recorder killed?); all of it is read");
  if (walk.has_end() && !footer)
    faults.add(file.size(), "the file has no footer (was it cut?); it is read without its summary");
  return layout;
}

}  // namespace penumbra::io::mcap
