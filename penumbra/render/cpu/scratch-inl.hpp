// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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
  std::uint32_t record;
  std::uint32_t offset;  // of its first block in the canvas, lanes
  float du, dv;          // of its first pixel from the record's, pixels
};

/// Triangles are sorted by the shape of their bounding box in blocks, so that each shape is filled
/// by one straight routine: the cost of loops with varying counts is mispredicted branches.
struct Scratch {
  static constexpr int small_width = 3;   // blocks
  static constexpr int small_height = 4;  // blocks
  static constexpr std::size_t small_bins = small_width * small_height;
  static constexpr std::size_t large_bin = small_bins;
  static constexpr std::size_t capacity = 1024;    // records of all bins together before a flush
  static constexpr std::size_t slack = 16;         // one vector of records
  static constexpr std::size_t longest_piece = 8;  // blocks
  static constexpr std::size_t piece_capacity = 4096;  // pieces of all lengths together
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

  std::size_t records = 0;  // in all bins
  std::array<std::uint32_t, small_bins + 1> bin_counts{};
  std::array<std::array<Record, capacity + slack>, small_bins + 1> bins;

  std::size_t pieces = 0;  // in all lengths
  std::array<std::uint32_t, longest_piece> piece_counts{};
  std::array<std::array<Piece, piece_capacity>, longest_piece> piece_bins;
};

}  // namespace penumbra::cpu
