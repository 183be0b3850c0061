// SPDX-License-Identifier: Apache-2.0
// Regions as rows of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/error.hpp>
#include <penumbra/occlusion/target.hpp>

namespace penumbra {

/// The user's region or target is at fault.
template <typename... Parts>
[[noreturn]] void region_fault(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw InputError(message.str());
}

/// Pixels [u0, u1) of row v, some of them.
struct RowSpan {
  int v, u0, u1;
};

/// The first of `count` bytes from p on that is not 0; `count` if all are.
[[nodiscard]] int first_set(const std::uint8_t* p, int count);

/// Pixels u0..u1 of rows v0..v1, all included.
struct SpanBox {
  int u0, u1, v0, v1;
};

/// The box around some spans, one or more.
[[nodiscard]] SpanBox box_of_spans(std::span<const RowSpan> spans);

/// The pixels of an image that show what the camera saw.
class SeenPixels {
 public:
  /// `unseen`: not 0 where they do not; empty: all do.
  explicit SeenPixels(ImageView<const std::uint8_t> unseen);

  [[nodiscard]] bool all() const { return ends_.empty(); }
  [[nodiscard]] std::span<const RowSpan> row(int v) const;  ///< not of all()
  /// Whether all pixels of a span, which may lie beside the image, are such; `width` and
  /// `height`: of the image.
  [[nodiscard]] bool hold(const RowSpan& span, int width, int height) const;

 private:
  std::vector<RowSpan> spans_;
  std::vector<std::size_t> ends_;  // of each row, in spans_
};

/// Takes an extent row by row, and keeps what of it lies inside an image. Rows outside of the image
/// are counted, not kept.
class ExtentRows {
 public:
  /// How many rows outside of the image are counted one by one. Of an extent with more of them,
  /// what lies outside is counted by its area.
  static constexpr double max_outside_rows = 1024;

  ExtentRows(int width, int height) : width_(width), height_(height) {}

  void clear();
  /// The pixels first <= u < end of row v; whole numbers of any size.
  void add(double v, double first, double end);
  void add_inside(int v, int u0, int u1) {
    spans_.push_back({v, u0, u1});
    inside_ += static_cast<std::size_t>(u1 - u0);
    covered_ += u1 - u0;
  }
  void add_area(double pixels) { covered_ += pixels; }  ///< outside of the image
  void keep(const SeenPixels& seen);                    ///< takes the others for outside
  /// The pixel next to a point, for an extent that holds no pixel's centre.
  void add_nearest(const Eigen::Vector2d& point);

  /// Which whole rows v of an extent [top, bottom] are given to add(): all of them, or, where too
  /// many lie outside, those of the image.
  struct Range {
    double first, last;  ///< both included; first > last: none
    bool cut;            ///< rows outside of the image are left to add_area()
  };
  [[nodiscard]] Range rows(double top, double bottom) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return covered_ < 0.5; }
  [[nodiscard]] std::span<const RowSpan> spans() const { return spans_; }
  [[nodiscard]] std::size_t inside() const { return inside_; }
  [[nodiscard]] std::size_t covered() const;

 private:
  int width_, height_;
  std::vector<RowSpan> spans_, kept_;
  std::size_t inside_ = 0;
  double covered_ = 0;
};

/// Polygons as rows: a centre is inside where the outline winds around it. Where an edge runs
/// through a centre, the pixel counts for the polygon to its right or, along a level edge, below,
/// so that polygons which share an edge share no pixel.
class PolygonRows {
 public:
  /// Throws InputError for a polygon that is none: fewer than three corners, one that is not
  /// finite, no area, edges that cross.
  void fill(std::span<const Eigen::Vector2d> corners, ExtentRows& rows);

 private:
  struct Edge {
    Eigen::Vector2d top, bottom;  // by v
    int winding;                  // 1 where it runs downwards
    std::size_t corner;           // at which it begins
  };
  struct Crossing {
    double u;
    int winding;
  };

  void take(std::span<const Eigen::Vector2d> corners);
  void check_crossings() const;
  void sweep(ExtentRows::Range range, ExtentRows& rows);
  void add_row(double v, ExtentRows& rows) const;
  [[nodiscard]] double area(double top, double bottom) const;
  [[nodiscard]] Eigen::Vector2d middle() const;

  std::vector<Edge> edges_;  // by their tops
  std::vector<std::size_t> active_;
  std::vector<Crossing> crossings_;
  int turn_ = 0;  // winding of the inside
};

/// The pixels of a region inside an image, and how many it has in all. Allocates nothing for
/// regions of a size that was seen.
class RegionSpans {
 public:
  RegionSpans(int width, int height)
      : rows_(width, height), open_(static_cast<std::size_t>(height), closed) {}

  /// Throws InputError, which says what is wrong, for a region that is none.
  void fill(const Region& region);

  /// Spans of the image, moved by whole pixels; what moves out of the image is covered, not inside.
  void fill_moved(std::span<const RowSpan> spans, const Eigen::Vector2d& by);

  /// Takes what lies beside `seen` for outside of the image.
  void keep(const SeenPixels& seen) {
    if (!seen.all()) rows_.keep(seen);
  }

  [[nodiscard]] std::span<const RowSpan> spans() const { return rows_.spans(); }
  [[nodiscard]] std::size_t inside() const { return rows_.inside(); }
  [[nodiscard]] std::size_t covered() const { return rows_.covered(); }
  [[nodiscard]] Eigen::Vector2d middle() const;  ///< of the pixels inside, of which there are some

 private:
  static constexpr int closed = -1;

  void take(const PixelBox& box);
  void take(const PixelPolygon& polygon) { polygon_.fill(polygon.corners, rows_); }
  void take(const PixelMask& mask);
  void take(const RunLengthMask& mask);
  void take(const PixelEllipse& ellipse);
  void take(const RenderedRegion& region);
  void check_size(const char* what, int width, int height) const;
  void take_depth(const RenderedRegion& region, int v, int u0, int u1);
  void turn_column(int u);

  ExtentRows rows_;
  PolygonRows polygon_;
  std::vector<int> open_;              // of each row: where its span began, or closed
  std::vector<int> last_ends_, ends_;  // of a run-length mask's columns: rows where runs end
};

}  // namespace penumbra
