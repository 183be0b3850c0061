// SPDX-License-Identifier: Apache-2.0
// Files of point clouds, put together by the descriptions of their formats.
#pragma once

#include "files.hpp"

namespace penumbra::test {

/// As raw(), in the other byte order.
template <typename... T>
std::string raw_big(T... values) {
  std::string bytes;
  const auto add = [&](std::string number) { bytes.append(number.rbegin(), number.rend()); };
  (add(raw(values)), ...);
  return bytes;
}

/// As liblzf compresses what does not repeat: runs of up to 32 bytes.
inline std::string lzf(const std::string& in) {
  std::string out;
  for (std::size_t at = 0; at < in.size(); at += 32) {
    const std::string run = in.substr(at, 32);
    out += static_cast<char>(run.size() - 1) + run;
  }
  return out;
}

inline std::string pcd(const std::string& fields, int width, int height, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " + data;
}

/// `header`: NumPy's dictionary, of any length.
inline std::string npy(const std::string& header, const std::string& data, char version = 1) {
  const auto size = static_cast<unsigned>(header.size());
  return "\x93NUMPY" + raw(version, '\0') +
         (version == 1 ? raw(static_cast<unsigned short>(size)) : raw(size)) + header + data;
}

inline const std::string xyz_fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
inline const std::string mixed_fields =
    "FIELDS x y z rgb _ ring t n\nSIZE 4 4 4 4 1 2 8 1\nTYPE F F F F U U F I\n"
    "COUNT 1 1 1 1 2 1 1 3\n";

/// A point of mixed_fields.
inline std::string mixed_point(float x, int ring) {
  return raw(x, x + 1, x + 2) + raw(0x00102030U) + std::string(2, '\0') +
         raw(static_cast<unsigned short>(ring), 1e300 * x) + raw('\x01', '\xfe', '\x03');
}
inline std::string mixed_points() {
  return mixed_point(1, 7) + mixed_point(2, 8) + mixed_point(3, 9) + mixed_point(4, 65535);
}

/// The values of mixed_points() field by field, compressed.
inline std::string compressed_pcd() {
  const std::string points = mixed_points();
  const std::size_t step = points.size() / 4;
  std::string plain;
  std::size_t offset = 0;
  for (const std::size_t size : {4U, 4U, 4U, 4U, 2U, 2U, 8U, 3U}) {
    for (std::size_t i = 0; i < 4; ++i) plain += points.substr(i * step + offset, size);
    offset += size;
  }
  const std::string packed = lzf(plain);
  return pcd(mixed_fields, 2, 2, "binary_compressed\n") +
         raw(static_cast<unsigned>(packed.size()), static_cast<unsigned>(plain.size())) + packed;
}

inline std::string ascii_pcd() {
  return pcd(mixed_fields, 2, 1,
             "ascii\n1 -2.5 nan 4.2108e+06 0 0 7 1e300 1 -2 3\n"
             "0.1 +3e-39 -inf 2.3418052e-38 0 0 65535 -1e-300 -128 127 0\n");
}

// A vertex element behind another one with a list, and before one.
inline std::string ply(const std::string& format, const std::string& body) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement camera 2\n" +
         "property list uchar short ids\nproperty double f\nelement vertex 2\n" +
         "property float x\nproperty double y\nproperty float32 z\nproperty uchar red\n" +
         "property int16 ring\nelement face 1\nproperty list uchar int vertex_indices\n" +
         "end_header\n" + body;
}
inline std::string ascii_ply() {
  return ply("ascii", "2 5 6 0.5\n0 1.5\n1 2 3 255 -7\n-1.5 2e100 0 0 300\n3 0 1 1\n");
}
template <bool big>
std::string binary_ply() {
  const auto bytes = [](auto... values) { return big ? raw_big(values...) : raw(values...); };
  using Byte = unsigned char;
  return ply(big ? "binary_big_endian" : "binary_little_endian",
             bytes(Byte{2}, short{5}, short{6}, 0.5, Byte{0}, 1.5) +
                 bytes(1.0F, 2.0, 3.0F, Byte{255}, short{-7}) +
                 bytes(-1.5F, 2e100, 0.0F, Byte{0}, short{300}) + bytes(Byte{3}, 0, 1, 1));
}

// The headers are NumPy 1.24's, without some of the spaces at their ends.
inline std::string float_npy() {
  return npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 4), }   \n",
             raw(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F));
}
inline std::string fortran_npy() {
  return npy("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }\n",
             raw(1.0, 4.0, 2.0, 5.0, 3.0, 6.0));
}
inline std::string kitti() { return raw(1.0F, 2.0F, 3.0F, 0.5F, 4.0F, 5.0F, 6.0F, 0.25F); }

/// A good file of each kind: name and bytes.
inline std::vector<std::pair<std::string, std::string>> cloud_samples() {
  return {{"ascii.pcd", ascii_pcd()},
          {"binary.pcd", pcd(mixed_fields, 2, 2, "binary\n") + mixed_points()},
          {"compressed.pcd", compressed_pcd()},
          {"ascii.ply", ascii_ply()},
          {"little.ply", binary_ply<false>()},
          {"big.ply", binary_ply<true>()},
          {"float.npy", float_npy()},
          {"fortran.npy", fortran_npy()},
          {"kitti.bin", kitti()},
          {"long.pcd",
           pcd("FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 1\n", 1, 1, "binary\n") +
               raw(1.0F, 2.0F, 3.0F) + raw(std::uint64_t{1} << 60U)},
          {"five.bin", raw(-1.0F, 2.0F, 3.0F, 0.5F, 7.0F, 4.0F, -5.0F, 6.0F, 0.25F, 8.0F)}};
}

}  // namespace penumbra::test
