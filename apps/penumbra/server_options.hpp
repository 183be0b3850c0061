// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <io/web/web_server.hpp>

namespace CLI {
class App;
}

namespace penumbra::app {

/// The address of the viewer's page.
struct ServerArguments {
  std::optional<std::uint16_t> port;
  std::optional<std::string> address;
};

[[nodiscard]] io::WebOptions web_options(const ServerArguments& server);

/// --port and --address. `port_help`: the meaning of --port.
void add_server(CLI::App& app, ServerArguments& server, const std::string& port_help);
/// Throws InputError for an address without a port.
void check_server(const ServerArguments& server);

}  // namespace penumbra::app
