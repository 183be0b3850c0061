// SPDX-License-Identifier: Apache-2.0
// What a camera_info says, whatever it stands in, and the camera that it makes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/camera.hpp>

#include <io/files/yaml.hpp>

namespace penumbra::io {

/// Where a value stands: what throws, throws InputError that names it.
struct InfoPlace {
  const YamlNode* node = nullptr;  ///< of a file
  std::string name = {};           ///< of a value elsewhere

  [[noreturn]] void fail(const std::string& what) const {
    if (node != nullptr) node->fail(what);
    throw InputError(name + ": " + what);
  }

  /// Runs `call`; an InputError that it throws is told as a fault of this value.
  template <typename F>
  auto blamed_for(const F& call) const {
    try {
      return call();
    } catch (const InputError& fault) {
      fail(fault.what());
    }
  }
};

/// A value and where it stands.
template <typename T>
struct InfoValue {
  InfoPlace place;
  T value{};
};

struct InfoMatrix {
  InfoPlace place;
  std::vector<double> values;  ///< finite

  void require(std::size_t count) const;
  void require(std::size_t i, double wanted, const std::string& why) const;
};

/// The window of the images in the full resolution.
struct InfoWindow {
  InfoPlace place;
  InfoValue<std::int64_t> x, y, width, height;
  InfoValue<bool> do_rectify;
};

/// Each value is looked for when it is asked for: what is not needed may be missing.
class CameraInfoFields {
 public:
  virtual ~CameraInfoFields() = default;
  [[nodiscard]] virtual InfoValue<std::int64_t> width() const = 0;
  [[nodiscard]] virtual InfoValue<std::int64_t> height() const = 0;
  [[nodiscard]] virtual InfoValue<std::string> distortion_model() const = 0;
  [[nodiscard]] virtual InfoMatrix k() const = 0;
  [[nodiscard]] virtual InfoMatrix d() const = 0;
  [[nodiscard]] virtual InfoMatrix r() const = 0;
  [[nodiscard]] virtual InfoMatrix p() const = 0;
  [[nodiscard]] virtual InfoValue<std::int64_t> binning_x() const = 0;  ///< 0: none
  [[nodiscard]] virtual InfoValue<std::int64_t> binning_y() const = 0;
  [[nodiscard]] virtual std::optional<InfoWindow> roi() const = 0;
  [[nodiscard]] virtual std::string frame_id() const = 0;
};

/// The camera of the images as they come (read_camera_info).
[[nodiscard]] Camera camera_of(const CameraInfoFields& info, bool rectified);

}  // namespace penumbra::io
