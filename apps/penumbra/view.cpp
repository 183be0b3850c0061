// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdint>
#include <iostream>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/view_source.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

using namespace std::chrono_literals;

constexpr auto look_period = 100ms;
constexpr auto long_time = 24h;
constexpr std::uint16_t more_ports = 99;  // that are tried if the default one is in use

/// Until Ctrl-C.
void wait_for_end(StopSignal& stop, ViewSource& source) {
  while (!source.is_over())
    if (stop.wait(look_period)) return;
  source.tell();
  std::cout.flush();
  while (!stop.wait(long_time)) continue;
}

}  // namespace

int execute(const ViewArguments& arguments) {
  StopSignal stop;
  ViewSource source(arguments);
  io::WebOptions options = web_options(arguments.server);
  if (!arguments.server.port) options.last_port = options.port + more_ports;
  const io::WebServer server(options, source.view());
  std::cout << server.url() << std::endl;
  source.start();
  wait_for_end(stop, source);
  return 0;
}

}  // namespace penumbra::app
