// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Core>

namespace example {

/// Numbers as text: the shortest that reads back to the same double, or a number of decimals.
[[nodiscard]] std::string shortest(double value);
[[nodiscard]] std::string shortest(const Eigen::Vector3d& values);
[[nodiscard]] std::string fixed(double value, int decimals);
[[nodiscard]] std::string fixed(const Eigen::Vector3d& values, int decimals);

/// Throws std::runtime_error if the file cannot be written.
void write_file(const std::filesystem::path& file, const std::string& bytes);

}  // namespace example
