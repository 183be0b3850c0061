// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <io/web/web_server.hpp>

namespace penumbra::io {

struct WebServer::State {};

WebServer::WebServer(const WebOptions& /*options*/, WebHandler& /*handler*/) {
  throw InputError(
      "this build has no viewer: install libboost-dev and build again with "
      "-DPENUMBRA_WITH_VIEWER=ON");
}
WebServer::~WebServer() = default;
std::string WebServer::url() const { return {}; }
std::uint16_t WebServer::port() const { return 0; }
void WebServer::wake() {}

}  // namespace penumbra::io
