// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/sink.hpp>

namespace penumbra::io {

/// Opens a bag of results: topics /penumbra/..., each message with its image's stamp, which is also
/// its log time. Frames without a stamp are refused. `file` itself is not touched before finish().
/// Throws InputError if its folder cannot be written.
[[nodiscard]] std::unique_ptr<Sink> open_output_bag(const std::filesystem::path& file,
                                                    const Pipeline& pipeline);

/// Throws InputError unless `file` is missing, empty or a bag of results.
void check_former_bag(const std::filesystem::path& file);

}  // namespace penumbra::io
