// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/options.hpp>
#include <apps/penumbra/server_options.hpp>

namespace penumbra::app {
namespace {

constexpr std::uint16_t most_port = 65535, default_port = 8470;

}  // namespace

io::WebOptions web_options(const ServerArguments& server) {
  io::WebOptions options{.port = server.port.value_or(default_port)};
  if (server.address) options.address = *server.address;
  return options;
}

void add_server(CLI::App& app, ServerArguments& server, const std::string& port_help) {
  add_number<std::uint16_t>(app, "--port", port_help, "N", server.port, 0, most_port);
  add_text(app, "--address",
           "IP address to serve on; default 127.0.0.1, this machine alone; another needs the token "
           "that is printed",
           "IP", server.address);
}

void check_server(const ServerArguments& server) {
  if (server.address && !server.port)
    throw InputError("--address: belongs to the page that --port serves; give --port, too");
}

}  // namespace penumbra::app
