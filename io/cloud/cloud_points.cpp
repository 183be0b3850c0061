// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include <penumbra/labels/labels.hpp>

#include <io/cloud/cloud_points.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr double nanosecond = 1e-9;
constexpr double same_clock = 10.0;  // seconds

/// Bytes of PointField's types 1 to 8.
constexpr std::array<std::size_t, 9> field_sizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};

std::size_t size_of(const PointFieldMessage& field) {
  return field.datatype < field_sizes.size() ? field_sizes[field.datatype] : 0;
}

/// Reads a number of one of PointField's types.
double number_at(const std::byte* at, std::uint8_t type, bool is_swapped) {
  std::array<std::byte, 8> bytes{};
  const std::size_t size = field_sizes[type];
  std::copy_n(at, size, bytes.begin());
  if (is_swapped) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
  const auto as = [&]<typename T>(T value) {
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 1:
      return as(std::int8_t{});
    case 2:
      return as(std::uint8_t{});
    case 3:
      return as(std::int16_t{});
    case 4:
      return as(std::uint16_t{});
    case 5:
      return as(std::int32_t{});
    case 6:
      return as(std::uint32_t{});
    case 7:
      return as(float{});
    default:
      return as(double{});
  }
}

/// The places of a cloud's points and fields.
class PointTable {
 public:
  explicit PointTable(const PointCloud2Message& cloud) : cloud_(cloud) {}

  [[nodiscard]] std::size_t count() const { return std::size_t{cloud_.width} * cloud_.height; }
  [[nodiscard]] bool is_swapped() const {
    return cloud_.is_bigendian != (std::endian::native == std::endian::big);
  }
  [[nodiscard]] bool has_gaps() const {
    return cloud_.height > 1 && cloud_.row_step != std::size_t{cloud_.width} * cloud_.point_step;
  }
  [[nodiscard]] std::size_t offset(std::size_t point) const {
    return cloud_.width == 0
               ? 0
               : point / cloud_.width * cloud_.row_step + point % cloud_.width * cloud_.point_step;
  }
  [[nodiscard]] double at(std::size_t point, const PointFieldMessage& field) const {
    return number_at(cloud_.data.data() + offset(point) + field.offset, field.datatype,
                     is_swapped());
  }
  [[nodiscard]] const PointFieldMessage* find(std::string_view name) const {
    for (const PointFieldMessage& field : cloud_.fields)
      if (field.name == name) return &field;
    return nullptr;
  }

  /// Returns which number of the message is a lie, or nothing.
  [[nodiscard]] std::string fault() const {
    const std::size_t row = std::size_t{cloud_.width} * cloud_.point_step;
    const std::size_t others = std::max(cloud_.height, 1U) - 1, size = cloud_.data.size();
    if (count() > 0 && (row > size || others * cloud_.row_step > size - row ||
                        (others > 0 && cloud_.row_step < row)))
      return std::to_string(cloud_.width) + " x " + std::to_string(cloud_.height) + " points of " +
             std::to_string(cloud_.point_step) + " bytes, in rows of " +
             std::to_string(cloud_.row_step) + " bytes, do not fit into " +
             std::to_string(cloud_.data.size()) + " bytes";
    for (const PointFieldMessage& field : cloud_.fields)
      if (size_of(field) == 0 || field.offset > cloud_.point_step ||
          size_of(field) * std::max<std::size_t>(1, field.count) > cloud_.point_step - field.offset)
        return "field '" + printable(field.name) + "' of type " + std::to_string(field.datatype) +
               " at byte " + std::to_string(field.offset) + " is not within a point of " +
               std::to_string(cloud_.point_step) + " bytes";
    return {};
  }

 private:
  const PointCloud2Message& cloud_;
};

/// Writes the times, seconds times `unit` after `from`, as nanoseconds. Those that are not finite
/// are at 0.
void set_times(const std::vector<double>& values, double from, double unit,
               std::vector<std::int32_t>& times) {
  times.clear();
  for (const double value : values) {
    const double time = (value - from) * unit / nanosecond;
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    times.push_back(std::abs(time) <= most ? static_cast<std::int32_t>(time) : 0);
  }
}

/// Finds what the numbers of a field mean.
void understand_times(const std::string& name, const std::vector<double>& values,
                      std::int64_t stamp, CloudPoints& out) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  const double length = most - least;
  if (!(length > 0.0)) return;  // all at once, or none
  const double seconds = static_cast<double>(stamp) * nanosecond;
  const std::string field = "field '" + printable(name) + "' has the points' times: ";
  constexpr std::array<std::pair<double, const char*>, 4> units = {
      std::pair(1.0, "seconds"), std::pair(1e-3, "milliseconds"), std::pair(1e-6, "microseconds"),
      std::pair(1e-9, "nanoseconds")};
  for (const auto& [unit, word] : units)
    if (seconds > same_clock && std::abs(least * unit - seconds) < same_clock) {
      out.time_note = field + word + " since 1970";
      return set_times(values, seconds / unit, unit, out.times);
    }
  constexpr double shortest = 1e-3, longest = 1.0;  // scans, seconds
  for (const auto& [unit, word] : units) {
    if (length * unit < shortest || length * unit > longest) continue;
    const bool is_relative = std::abs(least * unit) < same_clock;
    out.time_note = field + word + (is_relative ? " after the stamp" : " of a clock of its own");
    return set_times(values, is_relative ? 0.0 : least, unit, out.times);
  }
  out.time_note =
      field + "not used, they are from " + std::to_string(least) + " to " + std::to_string(most);
}

void read_times(const PointTable& table, std::int64_t stamp, CloudPoints& out) {
  for (const char* const name : {"t", "time", "timestamp", "time_stamp", "offset_time"}) {
    const PointFieldMessage* const field = table.find(name);
    if (field == nullptr) continue;
    std::vector<double> values(table.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = table.at(i, *field);
    return understand_times(name, values, stamp, out);
  }
}

void view_copied(CloudPoints& out) {
  out.points = {std::as_bytes(std::span(out.copied)).data(), out.copied.size() / 3};
}

bool stays(const CloudReport& report, std::size_t point) {
  return is_trusted(static_cast<Label>(report.labels[point]));
}

}  // namespace

std::string read_points(const PointCloud2Message& cloud, CloudPoints& out) {
  out.points = {};
  out.times.clear();
  out.time_note.clear();
  const PointTable table(cloud);
  if (std::string fault = table.fault(); !fault.empty()) return fault;
  std::array<const PointFieldMessage*, 3> axes{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string name(1, "xyz"[i]);
    axes[i] = table.find(name);
    if (axes[i] == nullptr) return "the cloud has no field '" + name + "'";
    if (axes[i]->datatype < PointFieldMessage::float32)
      return "field '" + name + "' is of type " + std::to_string(axes[i]->datatype) +
             "; expected float32 (7) or float64 (8)";
  }
  bool lies_ready = !table.is_swapped() && !table.has_gaps();
  for (std::size_t i = 0; i < axes.size(); ++i)
    lies_ready &= axes[i]->datatype == PointFieldMessage::float32 &&
                  axes[i]->offset == axes[0]->offset + i * sizeof(float);
  if (lies_ready) {
    out.points = {cloud.data.data() + axes[0]->offset, table.count(),
                  static_cast<std::ptrdiff_t>(cloud.point_step)};
  } else {
    out.copied.clear();
    for (std::size_t i = 0; i < table.count(); ++i)
      for (const PointFieldMessage* axis : axes)
        out.copied.push_back(static_cast<float>(table.at(i, *axis)));
    view_copied(out);
  }
  read_times(table, cloud.header.stamp, out);
  return {};
}

std::string read_points(const LaserScanMessage& scan, CloudPoints& out) {
  out.copied.clear();
  out.times.clear();
  out.time_note.clear();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    const float angle = scan.angle_min + static_cast<float>(i) * scan.angle_increment;
    const bool is_measured = range >= scan.range_min && range <= scan.range_max;
    const float r = is_measured ? range : no_value;
    out.copied.insert(out.copied.end(), {r * std::cos(angle), r * std::sin(angle), 0.0F});
  }
  view_copied(out);
  const double step = scan.time_increment;
  if (std::isfinite(step) && step != 0.0 &&
      std::abs(step) * static_cast<double>(scan.ranges.size()) <= 1.0)
    for (std::size_t i = 0; i < scan.ranges.size(); ++i)
      out.times.push_back(static_cast<std::int32_t>(static_cast<double>(i) * step / nanosecond));
  return {};
}

std::string read_points(const LivoxMessage& cloud, CloudPoints& out) {
  out.points = {reinterpret_cast<const std::byte*>(cloud.points.data()) + offsetof(LivoxPoint, x),
                cloud.points.size(), sizeof(LivoxPoint)};
  out.times.clear();
  for (const LivoxPoint& point : cloud.points)
    out.times.push_back(static_cast<std::int32_t>(
        std::min<std::uint32_t>(point.offset_time, std::numeric_limits<std::int32_t>::max())));
  return {};
}

PointCloud2Message cloud_output(const PointCloud2Message& cloud, const CloudReport& report,
                                const CloudOutput& how, std::vector<std::byte>& data) {
  const PointTable table(cloud);
  PointCloud2Message out = cloud;
  const auto label_at = static_cast<std::uint32_t>(cloud.point_step);
  constexpr std::uint32_t added = sizeof(std::uint8_t) + sizeof(std::uint16_t);
  if (how.labelled) {
    std::erase_if(out.fields, [](const auto& f) { return f.name == "label" || f.name == "link"; });
    out.fields.push_back({.name = "label", .offset = label_at, .datatype = 2});
    out.fields.push_back({.name = "link", .offset = label_at + 1, .datatype = 4});
    out.point_step += added;
  }
  const bool is_image = cloud.height > 1;
  data.clear();
  data.reserve(table.count() * out.point_step);
  std::uint32_t left = 0;
  for (std::size_t i = 0; i < table.count(); ++i) {
    const bool stay = how.labelled || stays(report, i);
    if (!stay && !is_image) continue;
    ++left;
    const std::byte* const from = cloud.data.data() + table.offset(i);
    data.insert(data.end(), from, from + cloud.point_step);
    std::byte* const to = data.data() + data.size() - cloud.point_step;
    if (!stay)
      for (const char* const axis : {"x", "y", "z"}) {
        const PointFieldMessage& field = *table.find(axis);
        // All ones are a NaN of either size and byte order.
        std::fill_n(to + field.offset, size_of(field), std::byte{0xff});
      }
    if (how.labelled) {
      std::array<std::byte, sizeof(std::uint16_t)> link;
      std::memcpy(link.data(), &report.point_links[i], sizeof link);
      if (table.is_swapped()) std::reverse(link.begin(), link.end());
      data.push_back(static_cast<std::byte>(report.labels[i]));
      data.insert(data.end(), link.begin(), link.end());
    }
  }
  if (!is_image) out.width = left;
  out.row_step = out.width * out.point_step;
  out.data = data;
  out.is_dense = cloud.is_dense && (how.labelled || !is_image);
  return out;
}

LaserScanMessage cloud_output(const LaserScanMessage& scan, const CloudReport& report,
                              const CloudOutput& how, std::vector<std::byte>& /*data*/) {
  LaserScanMessage out = scan;
  const float none = how.infinite_ranges ? std::numeric_limits<float>::infinity() : no_value;
  for (std::size_t i = 0; i < out.ranges.size(); ++i) {
    const bool is_measured = scan.ranges[i] >= scan.range_min && scan.ranges[i] <= scan.range_max;
    if (is_measured && !stays(report, i)) out.ranges[i] = none;
  }
  return out;
}

LivoxMessage cloud_output(const LivoxMessage& cloud, const CloudReport& report,
                          const CloudOutput& /*how*/, std::vector<std::byte>& /*data*/) {
  LivoxMessage out = cloud;
  out.points.clear();
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (stays(report, i)) out.points.push_back(cloud.points[i]);
  out.point_num = static_cast<std::uint32_t>(out.points.size());
  return out;
}

}  // namespace penumbra::io
