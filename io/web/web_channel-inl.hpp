// SPDX-License-Identifier: Apache-2.0
// The shared state of the server's connections, and the WebSocket connections.
#pragma once

#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <io/web/shared_limit-inl.hpp>
#include <io/web/web_guard.hpp>
#include <io/web/web_server.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;

using Request = http::request<http::empty_body>;

inline std::size_t size_of(const std::vector<SharedBytes>& body) {
  std::size_t bytes = 0;
  for (const SharedBytes& part : body) bytes += part->size();
  return bytes;
}

class Channel;

/// The shared state of all connections.
struct Shared {
  Shared(const WebOptions& options_, WebHandler& handler_, WebGuard guard_)
      : options(options_),
        handler(handler_),
        guard(std::move(guard_)),
        unauthenticated(options.max_unauthenticated),
        authenticated(options.max_connections),
        waiting(options.max_waiting_bytes) {}

  WebOptions options;
  WebHandler& handler;
  WebGuard guard;
  SharedLimit unauthenticated;  // connections that have not shown the token
  SharedLimit authenticated;    // connections that have; the last used is the newest
  SharedLimit waiting;          // bytes
  std::mutex channels_mutex;
  std::list<std::weak_ptr<Channel>> channels;
};

/// Returns a function that ends a client's connection on its strand. Any thread may call it.
template <typename Client>
std::function<void()> close_of(std::weak_ptr<Client> weak) {
  return [weak = std::move(weak)] {
    if (const auto client = weak.lock())
      asio::post(client->executor(), [client] { client->close(); });
  };
}

/// A WebSocket client. One message is sent at a time, and the next one is requested after that. So
/// a slow client holds one message and misses those in between.
class Channel : public std::enable_shared_from_this<Channel> {
 public:
  static constexpr std::size_t most_message_bytes = 4 * 1024;  // for messages of clients

  Channel(beast::tcp_stream stream, Shared& shared, std::unique_ptr<WebChannel> channel)
      : shared_(shared), stream_(std::move(stream)), channel_(std::move(channel)) {}

  void run(const Request& request) {
    keep_alive();
    socket().expires_never();
    auto times = websocket::stream_base::timeout::suggested(beast::role_type::server);
    times.idle_timeout = std::chrono::seconds(30);
    times.keep_alive_pings = true;
    stream_.set_option(times);
    stream_.read_message_max(most_message_bytes);
    stream_.auto_fragment(false);  // no fragments of 4 KB
    stream_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
      if (error) return;
      {
        const std::lock_guard lock(self->shared_.channels_mutex);
        self->shared_.channels.remove_if([](const auto& other) { return other.expired(); });
        self->shared_.channels.push_back(self);
      }
      self->read();
      self->send();
    });
  }

  [[nodiscard]] asio::any_io_executor executor() { return stream_.get_executor(); }
  void close() { socket().close(); }

  void wake() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] { self->send(); });
  }

 private:
  [[nodiscard]] beast::tcp_stream& socket() { return beast::get_lowest_layer(stream_); }
  void keep_alive() { slot_.take(shared_.authenticated, close_of(weak_from_this())); }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->take();
    });
  }

  void take() {
    keep_alive();
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (!stream_.got_text()) return close(websocket::close_code::unknown_data);
    if (!channel_->take(text)) return close(websocket::close_code::policy_error);
    read();
    send();
  }

  void close(websocket::close_code code) {
    closing_ = true;
    if (sending_) return socket().close();
    stream_.async_close(code, [self = shared_from_this()](beast::error_code) {});
  }

  std::optional<std::vector<SharedBytes>> next() {
    try {
      return channel_->next();
    } catch (const std::exception&) {  // like status 500 for requests
      close(websocket::close_code::internal_error);
      return std::nullopt;
    }
  }

  void send() {
    if (sending_ || closing_ || !stream_.is_open()) return;
    auto message = next();
    if (!message) return;
    message_ = std::move(*message);
    sending_ = true;
    const auto place = shared_.waiting.add({size_of(message_), close_of(weak_from_this())});
    std::vector<asio::const_buffer> buffers;
    for (const SharedBytes& part : message_) buffers.emplace_back(part->data(), part->size());
    stream_.binary(true);
    const auto written = [self = shared_from_this(), place](beast::error_code error, std::size_t) {
      self->shared_.waiting.remove(place);
      self->sending_ = false;
      self->message_.clear();
      if (error) return;
      self->keep_alive();
      self->send();
    };
    stream_.async_write(buffers, written);
  }

  Shared& shared_;
  ConnectionSlot slot_;
  websocket::stream<beast::tcp_stream, false> stream_;  // without compression
  std::unique_ptr<WebChannel> channel_;
  beast::flat_buffer buffer_;
  std::vector<SharedBytes> message_;  // being sent
  bool sending_ = false, closing_ = false;
};

}  // namespace penumbra::io
