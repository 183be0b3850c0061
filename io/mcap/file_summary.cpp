// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <io/mcap/crc32.hpp>
#include <io/mcap/file_summary.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::size_t crc_block = std::size_t{256} << 10;
constexpr std::uint64_t least_chunk_bytes = record_head_bytes + 40;  // size of an empty chunk

bool has_summary_crc(FileWindow& window, const FooterRecord& footer) {
  const std::uint64_t end = window.file_size() - magic_bytes.size() - sizeof footer.summary_crc;
  Crc32 crc;
  for (std::uint64_t at = footer.summary_start; at < end;) {
    const auto bytes =
        window.view(at, static_cast<std::size_t>(std::min<std::uint64_t>(crc_block, end - at)));
    if (bytes.empty()) return false;
    crc.add(bytes);
    at += bytes.size();
  }
  return crc.value() == footer.summary_crc;
}

bool is_needed(Opcode opcode) {
  return opcode == Opcode::schema || opcode == Opcode::channel || opcode == Opcode::statistics ||
         opcode == Opcode::chunk_index;  // attachments and metadata are not read
}

// Reads a record of the summary. Returns whether it is valid.
bool take(FileSummary& summary, const RecordHead& head, std::span<const std::byte> content,
          std::uint64_t offset, FaultLog& faults) {
  switch (head.opcode) {
    case Opcode::schema:
    case Opcode::channel:
      summary.definitions.add(head.opcode, content, offset, faults);
      return true;
    case Opcode::statistics:
      summary.statistics = parse_statistics(content);
      return summary.statistics.has_value();
    case Opcode::chunk_index: {
      auto index = parse_chunk_index(content);
      if (index) summary.chunks.push_back(std::move(*index));
      return index.has_value();
    }
    default:
      return true;
  }
}

bool take_all(FileWindow& window, FileSummary& summary, FaultLog& faults) {
  const std::uint64_t end = window.file_size() - end_bytes;
  for (std::uint64_t at = summary.start; at < end;) {
    const auto head_bytes = window.view(at, record_head_bytes);
    if (end - at < record_head_bytes || head_bytes.size() < record_head_bytes) return false;
    const RecordHead head = parse_head(head_bytes);
    const std::uint64_t content_at = at + record_head_bytes;
    if (head.length > end - content_at) return false;
    at = content_at + head.length;
    if (!is_needed(head.opcode)) continue;
    if (head.length > max_definition_bytes) return false;
    const auto content = window.view(content_at, static_cast<std::size_t>(head.length));
    const std::uint64_t record_at = content_at - record_head_bytes;
    if (content.size() < head.length || !take(summary, head, content, record_at, faults))
      return false;
  }
  return true;
}

bool lie_in_order(std::vector<ChunkIndexRecord>& chunks, std::uint64_t begin, std::uint64_t end) {
  std::sort(chunks.begin(), chunks.end(),
            [](const auto& a, const auto& b) { return a.offset < b.offset; });
  for (const ChunkIndexRecord& chunk : chunks) {
    if (chunk.offset < begin || chunk.offset > end || chunk.length < least_chunk_bytes ||
        chunk.length > end - chunk.offset ||
        chunk.message_index_length > end - chunk.offset - chunk.length)
      return false;
    begin = chunk.offset + chunk.length + chunk.message_index_length;
  }
  return true;
}

}  // namespace

std::optional<FooterRecord> read_footer(FileWindow& window) {
  const std::uint64_t size = window.file_size();
  if (size < magic_bytes.size() + end_bytes) return std::nullopt;
  const auto bytes = window.view(size - end_bytes, end_bytes);
  if (bytes.size() < end_bytes) return std::nullopt;
  const RecordHead head = parse_head(bytes);
  const auto magic = bytes.last(magic_bytes.size());
  if (head.opcode != Opcode::footer || head.length != footer_bytes ||
      !std::equal(magic.begin(), magic.end(), magic_bytes.begin()))
    return std::nullopt;
  return parse_footer(bytes.subspan(record_head_bytes, footer_bytes));
}

std::optional<FileSummary> read_summary(FileWindow& window, const FooterRecord& footer,
                                        std::uint64_t data_begin, FaultLog& faults) {
  if (footer.summary_start == 0) return std::nullopt;
  const std::uint64_t footer_at = window.file_size() - end_bytes;
  const auto refuse = [&](const std::string& what) {
    faults.add(footer_at, "the summary " + what + "; the file is read without it");
    return std::nullopt;
  };
  if (footer.summary_start < data_begin || footer.summary_start > footer_at)
    return refuse("should begin at " + std::to_string(footer.summary_start) +
                  ", which lies outside of the file");
  if (footer.summary_crc != 0 && !has_summary_crc(window, footer))
    return refuse("has a wrong checksum");
  FileSummary summary;
  summary.start = footer.summary_start;
  if (!take_all(window, summary, faults)) return refuse("is damaged");
  if (!lie_in_order(summary.chunks, data_begin, summary.start))
    return refuse("has an index of chunks that overlap or lie outside of the data");
  return summary;
}

}  // namespace penumbra::io::mcap
