// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <io/mcap/records.hpp>

namespace penumbra::io::mcap {

/// Reads an MCAP file: chunks without compression, of lz4 and of zstd, or none; with or without
/// index and summary; also one that its recorder did not finish, or that is damaged. Whatever of it
/// can be read is read; each damaged chunk, and where the file is cut, is a fault.
/// Memory follows what the file really holds, whatever sizes it claims, and is bounded by about
/// 200 MB or a few times the largest chunk.
class Reader {
 public:
  /// Throws InputError that names the file where it cannot be read or does not begin as MCAP does.
  explicit Reader(const std::filesystem::path& file);
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  [[nodiscard]] const std::string& profile() const;  ///< "ros2"
  [[nodiscard]] const std::string& library() const;  ///< that wrote the file

  /// By id; all that messages refer to are there from the start, but in files whose index lies.
  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const;
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const;

  /// What the writer counted, where the file tells.
  [[nodiscard]] const std::optional<Statistics>& statistics() const;

  /// The next message by log time; those of one time come in the file's order. Its data are valid
  /// until the next call. False at the end. Messages of channels that the file does not tell of are
  /// left out, which is a fault.
  bool next(Message& message);

  /// What was found wrong so far, in the order of finding. All of it is known at the end.
  [[nodiscard]] const std::vector<Fault>& faults() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io::mcap
