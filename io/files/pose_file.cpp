// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>

#include <Eigen/SVD>

#include <penumbra/base/error.hpp>

#include <io/files/csv.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/numbers.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr double max_rotation_error = 1e-4;  // per element; files with few digits are off by less
constexpr double rounding = 1e-14;           // of doubles
constexpr double max_distance = 1e6;         // metres: float32 depths beyond would mean nothing
constexpr std::string_view expected_rows = "expected four rows of four comma-separated numbers";

Eigen::Matrix4d read_matrix(const std::filesystem::path& file) {
  const std::string text = read_csv(file);
  Eigen::Matrix4d matrix;
  CsvLines lines(text);
  int row = 0;
  for (; lines.next(); ++row) {
    const std::string place = file.string() + ":" + std::to_string(lines.line()) + ": ";
    if (row == 4) throw InputError(place + "is a fifth row; " + std::string(expected_rows));
    if (lines.cells().size() != 4)
      throw InputError(place + "has " + std::to_string(lines.cells().size()) + " cells; " +
                       std::string(expected_rows));
    for (int column = 0; column < 4; ++column) {
      const std::string_view cell = lines.cells()[static_cast<std::size_t>(column)];
      const auto value = parse_number<double>(cell);
      if (!value)
        throw InputError(place + "'" + printable(cell) + "' is no finite number; " +
                         std::string(expected_rows));
      matrix(row, column) = *value;
    }
  }
  if (row != 4)
    throw InputError(file.string() + ": has " + std::to_string(row) + " rows; " +
                     std::string(expected_rows));
  return matrix;
}

}  // namespace

Eigen::Isometry3d read_pose_csv(const std::filesystem::path& file) {
  const Eigen::Matrix4d matrix = read_matrix(file);
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw InputError(file.string() + ": is no rigid transform: its last row must be 0,0,0,1");

  const Eigen::Matrix3d given = matrix.topLeftCorner<3, 3>();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  const double error = (given - nearest).cwiseAbs().maxCoeff();
  if (!(error <= max_rotation_error))
    throw InputError(file.string() + ": is no rigid transform: its rotation part is off by " +
                     std::to_string(error) + "; at most 0.0001 is taken for rounding");
  if (nearest.determinant() < 0.0)
    throw InputError(file.string() +
                     ": is no rigid transform: it mirrors (determinant -1 instead of 1)");

  const Eigen::Vector3d position = matrix.topRightCorner<3, 1>();
  if (position.cwiseAbs().maxCoeff() > max_distance)
    throw InputError(file.string() + ": is more than 1000 km away; expected metres");

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = error <= rounding ? given : nearest;  // as it was written
  pose.translation() = position;
  return pose;
}

void write_pose_csv(const std::filesystem::path& file, const Eigen::Isometry3d& pose) {
  std::ostringstream text;
  text << pose.matrix().format(Eigen::IOFormat(17, Eigen::DontAlignCols, ",", "\n")) << '\n';
  write_file(file, text.str().data(), text.str().size());
}

}  // namespace penumbra::io
