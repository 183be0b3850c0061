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

#include <io/cloud/cloud_formats-inl.hpp>
#include <io/cloud/cloud_points.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr double nanosecond = 1e-9;
constexpr double shortest = 1e-3, longest = 1.0;  // scans, seconds

std::size_t size_of(const PointFieldMessage& field) {
  return field.datatype < cloud_formats::number_types.size()
             ? cloud_formats::number_types[field.datatype].size
             : 0;
}

bool is_float(const PointFieldMessage& field) {
  return size_of(field) != 0 && cloud_formats::number_types[field.datatype].kind == 'F';
}

std::string fault_of_count(std::size_t points) {
  if (points <= most_cloud_points) return {};
  return "it has " + std::to_string(points) + " points, and the limit is " +
         std::to_string(most_cloud_points);
}

/// Reads a number of one of PointField's types.
double number_at(const std::byte* at, std::uint8_t type, bool is_swapped) {
  return cloud_formats::with_type(type, [&]<typename T>(T value) {
    std::array<std::byte, sizeof(T)> bytes;
    std::copy_n(at, bytes.size(), bytes.begin());
    if (is_swapped) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
  });
}

/// The places of a cloud's points and fields.
class PointTable {
 public:
  explicit PointTable(const PointCloud2Message& cloud)
      : cloud_(cloud),
        is_swapped_(cloud.is_bigendian != (std::endian::native == std::endian::big)) {
    if (fault().empty() && share_of_lengths(is_swapped_) < 0.5 &&
        share_of_lengths(!is_swapped_) > 0.95)
      is_swapped_ = !is_swapped_;
  }

  [[nodiscard]] std::size_t count() const { return std::size_t{cloud_.width} * cloud_.height; }
  /// By the numbers if is_bigendian is wrong.
  [[nodiscard]] bool is_swapped() const { return is_swapped_; }
  [[nodiscard]] bool is_order_wrong() const {
    return is_swapped_ == (cloud_.is_bigendian == (std::endian::native == std::endian::big));
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
    return at(point, field, is_swapped_);
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
    if (std::string many = fault_of_count(count()); !many.empty()) return many;
    for (const PointFieldMessage& field : cloud_.fields)  // those of unknown types are not read
      if (size_of(field) != 0 && (field.offset > cloud_.point_step ||
                                  size_of(field) * std::max<std::size_t>(1, field.count) >
                                      cloud_.point_step - field.offset))
        return "field '" + printable(field.name) + "' of type " + std::to_string(field.datatype) +
               " at byte " + std::to_string(field.offset) + " is not within a point of " +
               std::to_string(cloud_.point_step) + " bytes";
    return {};
  }

 private:
  [[nodiscard]] double at(std::size_t point, const PointFieldMessage& field, bool swapped) const {
    return number_at(cloud_.data.data() + offset(point) + field.offset, field.datatype, swapped);
  }

  /// Returns how many of the coordinates are lengths in this byte order, of those that are finite
  /// and not 0; 1 without any. In the other order a float's lowest byte becomes its exponent.
  [[nodiscard]] double share_of_lengths(bool swapped) const {
    constexpr double least = 1e-6, most = 1e6;
    constexpr std::size_t samples = 256;
    std::size_t all = 0, lengths = 0;
    for (const char* const axis : {"x", "y", "z"}) {
      const PointFieldMessage* const field = find(axis);
      if (field == nullptr || !is_float(*field)) continue;
      for (std::size_t i = 0; i < count(); i += 1 + count() / samples) {
        const double value = std::abs(at(i, *field, swapped));
        if (!std::isfinite(value) || value == 0.0) continue;
        ++all;
        lengths += value > least && value < most ? 1 : 0;
      }
    }
    return all == 0 ? 1.0 : static_cast<double>(lengths) / static_cast<double>(all);
  }

  const PointCloud2Message& cloud_;
  bool is_swapped_;
};

/// Finds what the numbers of a field mean, and sets the times. Returns why they are of no scan.
std::string set_times(const std::string& name, const std::vector<double>& values,
                      std::int64_t stamp, CloudPoints& out) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Points without measurement often have no time either.
    if (!std::isfinite(values[i]) || !(out.points[i].squaredNorm() > 0.0F)) continue;
    least = std::min(least, values[i]);
    most = std::max(most, values[i]);
  }
  const double length = most - least;
  const std::string field = "field '" + printable(name) + "'";
  if (!(length > 0.0)) return {};  // all at once
  const double seconds = static_cast<double>(stamp) * nanosecond;
  constexpr std::array<std::pair<double, const char*>, 4> units = {
      std::pair(1.0, "seconds"), std::pair(1e-3, "milliseconds"), std::pair(1e-6, "microseconds"),
      std::pair(1e-9, "nanoseconds")};
  for (const auto& [unit, word] : units) {
    if (length * unit < shortest || length * unit > longest) continue;
    const bool is_absolute = std::abs(least * unit - seconds) < longest;
    const bool is_relative = !is_absolute && std::abs(least * unit) < longest;
    const double from = is_absolute ? seconds / unit : is_relative ? 0.0 : least;
    out.time_note = field + " has the points' times: " + word +
                    (is_absolute   ? " of the stamp's clock"
                     : is_relative ? " after the stamp"
                                   : " of a clock of its own");
    for (const double value : values)
      out.times.push_back(value >= least && value <= most
                              ? static_cast<std::int32_t>((value - from) * unit / nanosecond)
                              : 0);
    return {};
  }
  return field + " has times from " + std::to_string(least) + " to " + std::to_string(most) +
         ", which is no scan of 1 ms to 1 s in any unit";
}

std::string read_times(const PointTable& table, std::int64_t stamp, CloudPoints& out) {
  for (const char* const name : {"t", "time", "timestamp", "time_stamp", "offset_time"}) {
    const PointFieldMessage* const field = table.find(name);
    if (field == nullptr) continue;
    if (size_of(*field) == 0)
      return "field '" + std::string(name) + "' is of the unknown type " +
             std::to_string(field->datatype) + "; --ignore-times leaves it unread";
    std::vector<double> values(table.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = table.at(i, *field);
    return set_times(name, values, stamp, out);
  }
  out.time_note = "the points have no times: all are labelled by the robot's pose at the stamp";
  return {};
}

bool is_range(const LaserScanMessage& scan, std::size_t i) {
  return scan.ranges[i] >= scan.range_min && scan.ranges[i] <= scan.range_max;
}

void view_copied(CloudPoints& out) {
  out.points = {std::as_bytes(std::span(out.copied)).data(), out.copied.size() / 3};
}

bool stays(const FrameReport& report, std::size_t point) {
  return is_trusted(static_cast<Label>(report.labels.data[point]));
}

}  // namespace

std::string read_points(const PointCloud2Message& cloud, bool use_times, CloudPoints& out) {
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
    if (!is_float(*axes[i]))
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
  std::string fault = use_times ? read_times(table, cloud.header.stamp, out) : std::string();
  if (table.is_order_wrong())
    out.time_note = std::string("is_bigendian is ") + (cloud.is_bigendian ? "true" : "false") +
                    ", and the numbers are in the other byte order: they are read in that order" +
                    (out.time_note.empty() ? "" : "; " + out.time_note);
  return fault;
}

std::string read_points(const LaserScanMessage& scan, bool use_times, CloudPoints& out) {
  out.copied.clear();
  out.times.clear();
  out.time_note.clear();
  if (std::string fault = fault_of_count(scan.ranges.size()); !fault.empty()) return fault;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    const float angle = scan.angle_min + static_cast<float>(i) * scan.angle_increment;
    const float r = is_range(scan, i) ? range : no_value;
    out.copied.insert(out.copied.end(), {r * std::cos(angle), r * std::sin(angle), 0.0F});
  }
  view_copied(out);
  const double step = scan.time_increment;
  if (!use_times || step == 0.0) return {};
  if (!(std::abs(step) * static_cast<double>(scan.ranges.size()) <= longest))
    return "its time_increment of " + std::to_string(step) + " s makes a scan of more than 1 s";
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    out.times.push_back(static_cast<std::int32_t>(static_cast<double>(i) * step / nanosecond));
  return {};
}

std::string read_points(const LivoxMessage& cloud, bool use_times, CloudPoints& out) {
  out.points = {reinterpret_cast<const std::byte*>(cloud.points.data()) + offsetof(LivoxPoint, x),
                cloud.points.size(), sizeof(LivoxPoint)};
  out.times.clear();
  if (std::string fault = fault_of_count(cloud.points.size()); !fault.empty()) return fault;
  if (!use_times) return {};
  for (const LivoxPoint& point : cloud.points) {
    if (point.offset_time * nanosecond > longest)
      return "an offset_time of " + std::to_string(point.offset_time) + " ns is more than 1 s";
    out.times.push_back(static_cast<std::int32_t>(point.offset_time));
  }
  return {};
}

Scan scan_of(const std::shared_ptr<const ReceivedCloud>& cloud, bool has_rays) {
  Scan scan{.points = cloud->points.points,
            .times = cloud->points.times,
            .owner = cloud,
            .received = cloud};
  if (!has_rays) scan.origin.reset();
  return scan;
}

PointCloud2Message cloud_output(const PointCloud2Message& cloud, const FrameReport& report,
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
      std::memcpy(link.data(), &report.virtual_depth.links.data[i], sizeof link);
      if (table.is_swapped()) std::reverse(link.begin(), link.end());
      data.push_back(static_cast<std::byte>(report.labels.data[i]));
      data.insert(data.end(), link.begin(), link.end());
    }
  }
  if (!is_image) out.width = left;
  out.row_step = out.width * out.point_step;
  out.data = data;
  out.is_dense = cloud.is_dense && (how.labelled || !is_image);
  return out;
}

LaserScanMessage cloud_output(const LaserScanMessage& scan, const FrameReport& report,
                              const CloudOutput& how, std::vector<std::byte>& /*data*/) {
  LaserScanMessage out = scan;
  for (std::size_t i = 0; i < out.ranges.size(); ++i) {
    if (!is_range(scan, i) || stays(report, i)) continue;
    const bool is_robot = static_cast<Label>(report.labels.data[i]) != Label::unknown;
    out.ranges[i] =
        how.infinite_ranges && is_robot ? std::numeric_limits<float>::infinity() : no_value;
  }
  return out;
}

LivoxMessage cloud_output(const LivoxMessage& cloud, const FrameReport& report,
                          const CloudOutput& /*how*/, std::vector<std::byte>& /*data*/) {
  LivoxMessage out = cloud;
  out.points.clear();
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (stays(report, i)) out.points.push_back(cloud.points[i]);
  out.point_num = static_cast<std::uint32_t>(out.points.size());
  return out;
}

}  // namespace penumbra::io
