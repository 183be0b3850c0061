// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <io/web/stored_view.hpp>

namespace penumbra::io {

/// One of several cameras that look at the same robot.
struct CameraPage {
  std::string name;
  StoredView* view;  ///< its frames; must outlive the page
};

/// Serves the pages of several cameras: /camera/NAME/ is one's, with its answers below it, / is the
/// first one's.
class CamerasView final : public WebHandler {
 public:
  /// `views`: returns views.json, or null until it is known.
  CamerasView(std::vector<CameraPage> cameras, std::function<SharedBytes()> views)
      : cameras_(std::move(cameras)), views_(std::move(views)) {}

  [[nodiscard]] WebAnswer answer(const WebRequest& request) override;
  [[nodiscard]] std::unique_ptr<WebChannel> open_channel(const std::string& path) override;

 private:
  std::vector<CameraPage> cameras_;
  std::function<SharedBytes()> views_;
};

}  // namespace penumbra::io
