// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <penumbra/render/clusters.hpp>

namespace penumbra::cpu {

/// A triangle ready to be filled: values at the centre of its first block's first pixel and slopes
/// in u and v of three edge functions (inside: not negative) and of 1/z.
struct alignas(64) Record {
  struct Quartet {
    float edge0, edge1, edge2, inverse_depth;
  };
  Quartet base, du, dv;
  std::uint32_t offset;  // of the first block in the canvas, lanes
  std::int32_t id;
  std::int32_t width, height;  // of the bounding box, blocks
};
static_assert(sizeof(Record) == 64);

/// A run of blocks in one block row of a large triangle.
struct Piece {
  std::int32_t record;  // index into Scratch::records
  std::int32_t offset;  // of its first block in the canvas, lanes
  float du, dv;         // of its first pixel from the record's, pixels
};

/// Pieces of one length.
struct PieceBin {
  static constexpr std::size_t budget = 2048;  // pieces of all lengths together before a flush
  /// One vector of rows of the widest image's triangle may come on top: 1024 pieces a row.
  static constexpr std::size_t capacity = budget + 16 * 1025;
  static constexpr std::size_t slack = 16;  // one vector

  std::size_t count = 0;
  alignas(64) std::array<std::int32_t, capacity + slack> record, offset;
  alignas(64) std::array<float, capacity + slack> du, dv;

  void push(const Piece& piece) {
    record[count] = piece.record;
    offset[count] = piece.offset;
    du[count] = piece.du;
    dv[count] = piece.dv;
    ++count;
  }
};

/// Triangles are sorted by the shape of their bounding box in blocks, so that each shape is filled
/// by one straight routine: the cost of loops with varying counts is mispredicted branches.
struct Scratch {
  static constexpr int small_width = 4;   // blocks
  static constexpr int small_height = 8;  // blocks
  static constexpr std::size_t small_bins = small_width * small_height;
  static constexpr std::size_t large_bins = 4;  // by vectors of block rows: 1, 2, 3, any
  static constexpr std::size_t slack = 16;      // one vector
  static constexpr std::size_t budget = 1024;   // records of all bins together before a flush
  static constexpr std::size_t bin_size = budget + slack;
  static constexpr std::size_t longest_piece = 8;  // blocks
  static constexpr std::size_t max_front = ClusteredScene::max_triangles;
  /// A clipped triangle has at most eight corners: six triangles.
  static constexpr std::size_t max_corners = max_front * 6 + slack;
  static constexpr std::size_t max_survivors = 512;

  // A cluster's vertices in the image, and its triangles that may be seen.
  alignas(64) std::array<float, 2 * (ClusteredScene::max_vertices + slack)> pixels;
  alignas(64) std::array<std::uint32_t, max_front + slack> front;  // index, turned: high bit

  // Corners of those triangles as (u, v) pairs.
  alignas(64) std::array<std::array<float, 2>, max_corners> corner0, corner1, corner2;
  alignas(64) std::array<std::uint32_t, max_corners> corner_triangle;

  // Triangles that may cover a pixel centre, of one body.
  std::size_t survivors = 0;
  std::uint32_t survivor_body = 0;
  alignas(64) std::array<std::array<float, max_survivors + max_corners + slack>, 6> survivor_pixels;
  alignas(64) std::array<std::uint32_t, max_survivors + max_corners + slack> survivor_triangle;
  alignas(64) std::array<std::uint32_t, max_survivors + max_corners + slack> survivor_cluster;

  std::size_t record_count = 0;  // in all bins
  std::array<Record, (small_bins + large_bins) * bin_size> records;
  std::array<Record*, small_bins + large_bins> bin_ends;

  Scratch() { clear_bins(); }
  Scratch(const Scratch&) = delete;  // bin_ends point inside
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::span<const Record> bin(std::size_t i) const {
    return {&records[i * bin_size], bin_ends[i]};
  }
  void clear_bins() {
    for (std::size_t i = 0; i < bin_ends.size(); ++i) bin_ends[i] = &records[i * bin_size];
    record_count = 0;
  }

  std::size_t piece_count = 0;                 // an upper bound over all lengths
  std::array<PieceBin, longest_piece> pieces;  // by length
};

}  // namespace penumbra::cpu
