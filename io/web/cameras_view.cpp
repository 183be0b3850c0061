// SPDX-License-Identifier: Apache-2.0
#include <io/web/cameras_view.hpp>

namespace penumbra::io {

WebAnswer CamerasView::answer(const WebRequest& request) {
  if (request.path == "/api/views") {
    const SharedBytes views = views_();
    return {.body = {views ? views : shared_bytes("null")}};
  }
  for (const CameraPage& camera : cameras_)
    if (const std::string start = "/camera/" + camera.name + "/"; request.path.starts_with(start))
      return camera.view->answer({request.path.substr(start.size() - 1), request.query});
  return cameras_.front().view->answer(request);
}

std::unique_ptr<WebChannel> CamerasView::open_channel(const std::string& /*path*/) {
  return nullptr;
}

}  // namespace penumbra::io
