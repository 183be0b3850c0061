// SPDX-License-Identifier: Apache-2.0
#include "viewer_process.hpp"

namespace penumbra::test {
namespace {

std::vector<std::string> line_of(const std::string& command, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), command);
  arguments.insert(arguments.end(), {"--port", "0"});
  return arguments;
}

}  // namespace

ViewerProcess::ViewerProcess(std::vector<std::string> arguments, const std::string& command)
    : program_(line_of(command, std::move(arguments)), folder_.path() / "log") {
  std::string log;
  eventually([&] {
    const bool is_last = program_.has_ended();
    log = read_bytes(folder_.path() / "log");
    const std::size_t url = log.find("http://"), end = log.find('\n', url);
    if (url == std::string::npos || end == std::string::npos) return is_last;
    port_ = static_cast<std::uint16_t>(std::stoi(log.substr(log.rfind(':', end) + 1)));
    return true;
  });
  EXPECT_NE(port_, 0) << log;
}

nlohmann::json ViewerProcess::get_json(const std::string& path) const {
  const HttpReply reply = client().get(path);
  EXPECT_EQ(reply.status, 200) << path << ": " << reply.body;
  return nlohmann::json::parse(reply.body);
}

Packet ViewerProcess::packet(std::size_t frame, const std::string& with) const {
  const HttpReply reply =
      client().get("/api/frames/" + std::to_string(frame) + "/packet?with=" + with);
  EXPECT_EQ(reply.headers.at("content-type"), "application/octet-stream");
  return Packet(reply.body);
}

nlohmann::json ViewerProcess::complete_session() const {
  nlohmann::json session;
  EXPECT_TRUE(eventually([&] {
    session = get_json("/api/session");
    return session["complete"] == true;
  }));
  return session;
}

}  // namespace penumbra::test
