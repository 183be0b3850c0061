// SPDX-License-Identifier: Apache-2.0
// The viewer's server, and the report that it shows.
#include "../web/web_client.hpp"
#include "readers.hpp"

#include <io/web/live_view.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::fuzz {
namespace {

using namespace io;

RunReport read_report(std::string_view text) { return RunReport::read(file("report.json", text)); }

/// Answers requests with a stored run, and WebSockets with a live one.
class Viewer final : public WebHandler {
 public:
  WebAnswer answer(const WebRequest& request) override { return stored_.answer(request); }
  std::unique_ptr<WebChannel> open_channel(const std::string& path) override {
    return live_.open_channel(path);
  }

 private:
  RunFolder run_{folder().path(),
                 read_report(R"({"input": "", "settings": {"image": "raw"}, "links": ["base"],
                                 "frames": [{"index": 0}], "summary": {}})")};
  StoredView stored_{SessionInfo{.input = "", .links = {"base"}, .camera = {}},
                     make_scene(std::vector<std::string>{"base"}), run_, 1};
  LiveView live_{"live"};
};

/// What a client sends until it closes its side; the word PORT in it is the server's port.
void serve(std::string_view bytes) {
  static Viewer viewer;
  static const WebServer server(WebOptions{}, viewer);
  std::string sent(bytes);
  if (const auto at = sent.find("PORT"); at != std::string::npos)
    sent.replace(at, 4, std::to_string(server.port()));
  test::WebClient client(server.port());
  client.send(sent);
  client.finish();
  require(client.is_closed(), "the server closes, too");
}

const Added web({{"http", serve, 500},
                 {"report", [](std::string_view text) { static_cast<void>(read_report(text)); }}});

}  // namespace
}  // namespace penumbra::fuzz
