// SPDX-License-Identifier: Apache-2.0
#include <io/files/exr.hpp>

#if PENUMBRA_WITH_EXR

#include <string>
#include <utility>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <penumbra/camera/camera.hpp>

#include <io/files/depth_pixels.hpp>

namespace penumbra::io {
namespace {

/// Returns the name of the depth channel; empty if it is not clear. `all`: their names.
std::string depth_channel(const Imf::ChannelList& channels, std::string& all) {
  std::vector<std::string> depths;
  std::size_t count = 0;
  for (auto at = channels.begin(); at != channels.end(); ++at, ++count) {
    const std::string name = at.name();
    all += (all.empty() ? "" : ", ") + name;
    const std::string last = name.substr(name.rfind('.') + 1);
    if (last == "Z" || last == "V" || last == "Y") depths.push_back(name);
  }
  if (count == 1) return all;
  return depths.size() == 1 ? depths.front() : std::string();
}

}  // namespace

FileResult read_exr_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                          std::optional<double> scale, SharedDepth& depth) {
  // Lying sizes are refused before memory is taken.
  Imf::Header::setMaxImageSize(Intrinsics::max_size, Intrinsics::max_size);
  Imf::Header::setMaxTileSize(Intrinsics::max_size, Intrinsics::max_size);
  Imf::InputFile input(file.c_str(), 0);
  const auto window = input.header().dataWindow();
  const ImageSize size{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1};
  if (auto fault = check_image_size(static_cast<std::uint64_t>(size.width),
                                    static_cast<std::uint64_t>(size.height)))
    return FileResult::bad(file, *fault);
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  if (auto fault = check_expansion(size, std::filesystem::file_size(file)))
    return FileResult::bad(file, *fault);
  std::string all;
  const std::string channel = depth_channel(input.header().channels(), all);
  if (channel.empty())
    return FileResult::bad(file, "has the channels " + all + "; expected one, or one called Z");
  Image<float> pixels(size.width, size.height);
  const auto columns = static_cast<std::ptrdiff_t>(size.width);
  const std::ptrdiff_t first = window.min.x + window.min.y * columns;
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() - first),
                                    sizeof(float), sizeof(float) * pixels.view().stride));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  depth = shared_depth_of(std::move(pixels), scale);
  return {};
}

}  // namespace penumbra::io

#else

namespace penumbra::io {

FileResult read_exr_depth(const std::filesystem::path& file, std::optional<ImageSize>,
                          std::optional<double>, SharedDepth&) {
  return FileResult::bad(file, "is an EXR file, which this build does not read (it lacks OpenEXR)");
}

}  // namespace penumbra::io

#endif
