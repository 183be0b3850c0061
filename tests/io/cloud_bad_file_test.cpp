// SPDX-License-Identifier: Apache-2.0
// Damaged point clouds are refused in one line that names the file, without large memory.
#include "../support/allocations.hpp"
#include "cloud_samples.hpp"

#include <io/cloud/cloud_file.hpp>

namespace penumbra::io {
namespace {

using test::raw;
using test::replaced;

// More than a header of 64 KiB takes, and less than any lie in a header asks for.
constexpr std::size_t cloud_memory = std::size_t{16} << 20;

/// Expects each file to be refused, by its name and the second text.
void expect_bad(const std::string& name, const test::BadInputs& files) {
  const test::TemporaryFolder folder;
  for (const auto& [bytes, named] : files) {
    const auto file = folder.write(name, bytes);
    const test::MemoryShortage shortage(cloud_memory, 0);
    test::expect_refused([&] { return read_cloud(file); }, {file.string() + ": ", named});
  }
}

TEST(CloudBadFile, PcdHeadersAreChecked) {
  const std::string good = test::pcd(test::xyz_fields, 1, 1, "binary\n") + raw(1.0F, 2.0F, 3.0F);
  const auto with = [&](const std::string& from, const std::string& to) {
    return replaced(good, from, to);
  };
  const auto sized = [&](const std::string& width, const std::string& height) {
    return replaced(replaced(with("\nPOINTS 1", ""), "WIDTH 1", "WIDTH " + width), "HEIGHT 1",
                    "HEIGHT " + height);
  };
  expect_bad("a.pcd", {{"", "DATA"},
                       {"VERSION 0.7\n" + std::string(std::size_t{1} << 20, 'x'), "65536"},
                       {with("FIELDS x y z", "FIELDS x y"), "FIELDS"},
                       {with("SIZE 4 4 4", "SIZE 4 4 3"), "3 bytes"},
                       {with("TYPE F F F", "TYPE F F X"), "\"z\""},
                       {with("COUNT 1 1 1", "COUNT 1 1 0"), "\"z\""},
                       {with("COUNT 1 1 1", "COUNT 1 1 2"), "16 bytes"},
                       {with("WIDTH 1\n", ""), "WIDTH"},
                       {with("POINTS 1", "POINTS 2"), "POINTS"},
                       {sized("10000000", "1"), "120000000 bytes"},
                       {sized("16000001", "1"), "16000000"},
                       {sized("-1", "1"), "WIDTH"},
                       {with("DATA binary", "DATA zip"), "zip"},
                       {good.substr(0, good.size() - 1), "truncated"},
                       {good + "x", "follow the last point"}});
}

TEST(CloudBadFile, PcdTextIsChecked) {
  const std::string good = test::pcd(test::xyz_fields, 1, 1, "ascii\n1 2 3\n");
  const std::string bytes = test::pcd("FIELDS a\nSIZE 1\nTYPE U\n", 1, 1, "ascii\n256\n");
  expect_bad("a.pcd",
             {{replaced(good, "1 2 3", "1 2"), "before its last point"},
              {replaced(good, "1 2 3", "1 2 3 4"), "follows the last"},
              {replaced(good, "1 2 3", "1 2 x"), "\"x\""},
              {replaced(good, "1 2 3", "1 2 1e39"), "1e39"},
              {bytes, "256"},
              {replaced(replaced(good, "WIDTH 1", "WIDTH 10000000"), "POINTS 1", "POINTS 10000000"),
               "30000000 numbers"}});
}

TEST(CloudBadFile, CompressedPointsAreChecked) {
  const std::string header = test::pcd("FIELDS a\nSIZE 1\nTYPE U\n", 4, 1, "binary_compressed\n");
  const auto packed = [&](const std::string& bytes, unsigned plain = 4) {
    return header + raw(static_cast<unsigned>(bytes.size()), plain) + bytes;
  };
  const auto c = [](int code) { return std::string(1, static_cast<char>(code)); };
  expect_bad("a.pcd", {{header + "1234567", "ends before"},
                       {header + raw(10U, 4U) + c(3) + "abcd", "10 bytes"},
                       {packed(c(3) + "abcd", 4294967295U), "4294967295"},
                       {packed(c(3) + "abcd") + "x", "follow"},
                       {packed(c(3) + "abc"), "run"},
                       {packed(c(2) + "abc"), "decompress"},
                       {packed(c(1) + "ab" + c(0xe0)), "reference"},
                       {packed(c(1) + "ab" + c(0x20) + c(2)), "before their first"},
                       {packed(c(0) + "a" + c(0xe0) + c(0xff) + c(0)), "decompress"}});
  // 1 GB, of which 4 kB are there.
  std::string run = c(0) + "a";
  for (int i = 0; i < 1000; ++i) run += c(0xe0) + c(0xff) + c(0);
  const std::string large =
      test::pcd("FIELDS a\nSIZE 1\nTYPE U\nCOUNT 100\n", 10000000, 1, "binary_compressed\n");
  expect_bad("b.pcd",
             {{large + raw(static_cast<unsigned>(run.size()), 1000000000U) + run, "decompress"}});
}

TEST(CloudBadFile, PlyIsChecked) {
  const std::string text = test::ascii_ply();
  const std::string binary = test::binary_ply<false>();
  const std::string vertex = "element vertex 2";
  expect_bad("a.ply", {{"", "'ply'"},
                       {"ply\ncomment " + std::string(std::size_t{1} << 20, 'x'), "65536"},
                       {replaced(text, "format ascii", "format binary"), "binary"},
                       {replaced(text, "format ascii 1.0\n", ""), "format"},
                       {replaced(text, "vertex", "vertices"), "vertex"},
                       {replaced(text, vertex, "element vertex -2"), "count"},
                       {replaced(text, vertex, "element vertex 10000000"), "50000000 numbers"},
                       {replaced(binary, vertex, "element vertex 10000000"), "190000000 bytes"},
                       {replaced(text, "2 5 6 0.5", "-1 5 6 0.5"), "\"ids\""},
                       {replaced(text, "list uchar short", "list float short"), "integers"},
                       {replaced(text, "uchar red", "uint128 red"), "uint128"},
                       {replaced(text, "uchar red", "list uchar int red"), "\"red\""},
                       {replaced(text, "property uchar red", "property uchar"), "property"},
                       {replaced(text, "element camera 2\n", ""), "before any element"},
                       {replaced(text, "255 -7", "256 -7"), "256"},
                       {replaced(text, "255 -7", "255"), "no number"},
                       {"ply\nformat ascii 1.0\nelement vertex 3\nend_header\n", "no fields"},
                       {binary.substr(0, binary.find("end_header") + 40), "truncated"}});
}

TEST(CloudBadFile, NumpyIsChecked) {
  const std::string good = test::float_npy();
  const auto header = [&](const std::string& dictionary) {
    return test::npy(dictionary, raw(1.0F, 2.0F, 3.0F));
  };
  const auto shape = [&](const std::string& sizes, const std::string& type = "'<f4'") {
    return header("{'descr': " + type + ", 'fortran_order': False, 'shape': " + sizes + "}");
  };
  expect_bad("a.npy", {{"", "NumPy"},
                       {replaced(good, "NUMPY\x01", "NUMPY\x04"), "version 4"},
                       {replaced(good, "NUMPY\x01", "NUMPY\x03"), "header"},
                       {good.substr(0, 40), "header"},
                       {good.substr(0, good.size() - 1), "truncated"},
                       {good + "x", "follow"},
                       {shape("(3,)"), "1 dimensions"},
                       {shape("(1, 2)"), "C >= 3"},
                       {shape("(3, 100000)"), "transposed?"},
                       {shape("(10000000, 3)"), "120000000"},
                       {shape("(16000001, 3)"), "16000000"},
                       {shape("(-1, 3)"), "plain array"},
                       {shape("(1, 3)", "'<f2'"), "<f2"},
                       {shape("(1, 3)", "'>f4'"), ">f4"},
                       {shape("(1,)", "[('x', '<f4')]"), "plain array"},
                       {header("[1]"), "plain array"}});
}

TEST(CloudBadFile, OtherFilesAreNamed) {
  expect_bad("a.bin", {{"0123456789abcde", "15 bytes"}});
  expect_bad("a.las", {{"LASF", ".pcd"}});
  const test::TemporaryFolder folder;
  test::expect_refused([&] { return read_cloud(folder.path() / "none.pcd"); }, {"none.pcd"});
  std::filesystem::create_directory(folder.path() / "folder.pcd");
  test::expect_refused([&] { return read_cloud(folder.path() / "folder.pcd"); }, {"folder.pcd"});
  const auto large = folder.write("large.pcd", "");
  std::filesystem::resize_file(large, std::uintmax_t{1} << 40);  // a sparse file
  test::expect_refused([&] { return read_cloud(large); }, {large.string(), "limit"});
}

TEST(CloudBadFile, CloudsThatDoNotFitAreNotWritten) {
  const test::TemporaryFolder folder;
  const auto expect_unwritten = [&](const char* name, std::string_view part, const auto& change) {
    StoredCloud stored = read_cloud(folder.write("good.bin", test::kitti()));
    change(stored.cloud);
    const auto file = folder.path() / name;
    test::expect_refused([&] { write_cloud(file, stored.cloud); }, {file.string(), part});
    EXPECT_FALSE(std::filesystem::exists(file));
  };
  using Cloud = PointCloud2Message;
  expect_unwritten("a.txt", ".pcd", [](Cloud&) {});
  expect_unwritten("a.pcd", "limit", [](Cloud& c) { c.fields.resize(20000, c.fields[0]); });
  expect_unwritten("a.npy", "x y z", [](Cloud& c) { c.fields[0].name = "i"; });
  expect_unwritten("a.bin", "x y z i;", [](Cloud& c) { c.fields[3].name = "i"; });
  expect_unwritten("a.bin", "label", [](Cloud& c) { c.fields.push_back({"label", 0, 2, 1}); });
  expect_unwritten("a.bin", "float32", [](Cloud& c) { c.fields[3].datatype = 6; });
  expect_unwritten("none/a.pcd", "written", [](Cloud&) {});
}

}  // namespace
}  // namespace penumbra::io
