// SPDX-License-Identifier: Apache-2.0
// The server, on Boost.Beast and Asio.
#include <array>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/write.hpp>
#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/web/web_channel-inl.hpp>
#include <io/web/web_server.hpp>
#include <io/web/web_types.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint32_t most_header_bytes = 8 * 1024;
constexpr int send_buffer_bytes = 512 * 1024;  // kernel buffer of each connection
constexpr auto closing_time = std::chrono::seconds(2);
constexpr auto accept_pause = std::chrono::milliseconds(100);

// Scripts, styles and images are loaded from this server only. No other page may frame the page,
// and it sends nothing elsewhere.
constexpr const char* content_policy =
    "default-src 'self'; img-src 'self' blob: data:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

using Head = http::response_header<http::fields>;

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }
beast::string_view beast_view(std::string_view text) { return {text.data(), text.size()}; }

WebSender sender_of(const Request& request) {
  WebSender sender;
  if (request.count(http::field::host) == 1) sender.host = view_of(request[http::field::host]);
  if (const auto at = request.find(http::field::origin); at != request.end())
    sender.origin = view_of(at->value());
  sender.cookies = view_of(request[http::field::cookie]);
  return sender;
}

std::string machine_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  return name.data();
}

/// An HTTP client. Reads and answers one request at a time.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Shared& shared)
      : shared_(shared), stream_(std::move(socket)), buffer_(most_header_bytes + 1024) {
    beast::error_code ignored;
    stream_.socket().set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    stream_.socket().set_option(tcp::no_delay(true), ignored);
  }

  [[nodiscard]] const asio::any_io_executor& executor() const { return executor_; }
  void close() {
    if (!is_upgraded_) stream_.close();
  }

  void run() {
    slot_.take(shared_.unauthenticated, close_of(weak_from_this()));
    asio::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->read(); });
  }

 private:
  void read() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    stream_.expires_after(shared_.options.request_time);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (error) return self->refuse_malformed(error);
                       self->handle();
                     });
  }

  void refuse_malformed(beast::error_code error) {
    if (error == beast::error::timeout) return;  // the stream is closed already
    if (error == http::error::end_of_stream ||
        error.category() != http::make_error_code(http::error::bad_method).category())
      return close_after_answer();
    keep_alive_ = false;
    version_ = 11;
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
      return answer(web_error(431, "the request's header is larger than 8 KiB"));
    if (error == http::error::unexpected_body || error == http::error::body_limit)
      return answer(web_error(413, "requests have no body here"));
    answer(web_error(400, "the request is not HTTP"));
  }

  void handle() {
    const Request request = parser_->release();
    keep_alive_ = request.keep_alive();
    is_head_ = request.method() == http::verb::head;
    version_ = request.version();
    const WebSender sender = sender_of(request);
    if (const auto refusal = shared_.guard.refuse(sender)) return answer(*refusal);
    if (request.method() != http::verb::get && !is_head_)
      return answer(web_error(405, "only GET and HEAD are served"));
    const auto target = parse_target(view_of(request.target()));
    if (!target) return answer(web_error(400, "the request's path is invalid"));
    const bool brings_token = shared_.guard.brings_token(*target);
    if (!brings_token && !shared_.guard.knows_token(sender))
      return answer(web_error(401, "the token is missing; open the address that was printed"));
    slot_.take(shared_.authenticated, close_of(weak_from_this()));
    if (brings_token) return admit();
    if (websocket::is_upgrade(request)) return upgrade(request, *target);
    answer(made_answer(*target));
  }

  /// Moves the token from the URL to a cookie, because browser histories keep URLs.
  void admit() {
    extra_.emplace_back(http::field::location, "/");
    extra_.emplace_back(http::field::set_cookie, shared_.guard.cookie());
    answer({.status = 303, .type = "text/plain", .body = {}});
  }

  WebAnswer made_answer(const WebRequest& request) {
    try {
      return shared_.handler.answer(request);
    } catch (const InputError& error) {
      return web_error(404, error.what());
    } catch (const std::exception& error) {
      return web_error(500, error.what());
    }
  }

  void upgrade(const Request& request, const WebRequest& target) {
    auto channel = shared_.handler.open_channel(target.path);
    if (!channel) return answer(web_error(404, "there is no WebSocket at " + target.path));
    is_upgraded_ = true;
    std::make_shared<Channel>(std::move(stream_), shared_, std::move(channel))->run(request);
  }

  Head head_of(const WebAnswer& answer) {
    Head head;
    head.version(version_);
    head.result(static_cast<unsigned>(answer.status));
    head.set(http::field::content_type, beast_view(answer.type));
    head.set(http::field::content_length, std::to_string(size_of(answer.body)));
    head.set(http::field::connection, keep_alive_ ? "keep-alive" : "close");
    head.set(http::field::cache_control,
             answer.keeps ? "private, max-age=31536000, immutable" : "no-store");
    head.set("Content-Security-Policy", content_policy);
    head.set("X-Content-Type-Options", "nosniff");
    head.set("Cross-Origin-Resource-Policy", "same-origin");
    head.set("Referrer-Policy", "no-referrer");
    if (answer.status == 405) head.set(http::field::allow, "GET, HEAD");
    for (const auto& [field, value] : std::exchange(extra_, {})) head.set(field, value);
    return head;
  }

  void answer(const WebAnswer& answer) {
    std::ostringstream head;
    head << head_of(answer);
    body_ = {shared_bytes(head.str())};
    if (!is_head_) body_.insert(body_.end(), answer.body.begin(), answer.body.end());
    std::vector<asio::const_buffer> buffers;
    for (const SharedBytes& part : body_) buffers.emplace_back(part->data(), part->size());
    const auto place = shared_.waiting.add({size_of(body_), close_of(weak_from_this())});
    stream_.expires_after(shared_.options.answer_time);
    asio::async_write(stream_, buffers,
                      [self = shared_from_this(), place](beast::error_code error, std::size_t) {
                        self->shared_.waiting.remove(place);
                        self->body_.clear();
                        if (error) return self->stream_.close();
                        if (!self->keep_alive_) return self->close_after_answer();
                        self->read();
                      });
  }

  void close_after_answer() {
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(closing_time);
    drain();
  }

  /// Reads the remaining bytes. Closing with unread bytes would discard the answer.
  void drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(most_header_bytes),
                            [self = shared_from_this()](beast::error_code error, std::size_t got) {
                              self->drained_ += got;
                              constexpr std::size_t most = std::size_t{1} << 20U;
                              if (!error && self->drained_ < most) self->drain();
                            });
  }

  Shared& shared_;
  ConnectionSlot slot_;
  beast::tcp_stream stream_;
  asio::any_io_executor executor_ = stream_.get_executor();  // outlives a move of the stream
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::vector<SharedBytes> body_;  // being sent
  std::vector<std::pair<http::field, std::string>> extra_;
  std::size_t drained_ = 0;
  unsigned version_ = 11;
  bool keep_alive_ = true, is_head_ = false;
  bool is_upgraded_ = false;  // the channel owns the stream
};

constexpr const char* address_help = "127.0.0.1 serves this machine, 0.0.0.0 all that reach it";

asio::ip::address address_of(const std::string& text) {
  beast::error_code error;
  auto address = asio::ip::make_address(text == "localhost" ? "127.0.0.1" : text, error);
  if (error) throw InputError("--address " + text + ": is not an IP address; " + address_help);
  return address;
}

beast::error_code listen(tcp::acceptor& acceptor, const tcp::endpoint& place) {
  beast::error_code error;
  acceptor = tcp::acceptor(acceptor.get_executor());
  acceptor.open(place.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(place, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  return error;
}

tcp::acceptor listener_of(asio::io_context& context, const WebOptions& options) {
  tcp::endpoint place(address_of(options.address), options.port);
  tcp::acceptor acceptor(context);
  beast::error_code error = listen(acceptor, place);
  while (error == asio::error::address_in_use && place.port() < options.last_port) {
    place.port(static_cast<std::uint16_t>(place.port() + 1));
    error = listen(acceptor, place);
  }
  if (error == boost::system::errc::address_not_available)
    throw InputError("--address " + options.address + ": is no address of this machine; " +
                     address_help);
  if (error)
    throw InputError("--port " + std::to_string(options.port) + ": " + options.address +
                     " cannot be listened on (" + error.message() +
                     "); --port 0 takes any port that is free");
  return acceptor;
}

WebGuard guard_of(const WebOptions& options, std::uint16_t port) {
  const bool is_loopback = address_of(options.address).is_loopback();
  return {{.address = options.address,
           .port = port,
           .is_loopback = is_loopback,
           .machine = machine_name()},
          is_loopback ? "" : random_token()};
}

}  // namespace

struct WebServer::State {
  State(const WebOptions& options, WebHandler& handler)
      : context(options.threads), acceptor(listener_of(context, options)), pause(context) {
    shared = std::make_unique<Shared>(options, handler,
                                      guard_of(options, acceptor.local_endpoint().port()));
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(context),
                          [this](beast::error_code error, tcp::socket socket) {
                            if (error) return wait_to_accept();
                            std::make_shared<Connection>(std::move(socket), *shared)->run();
                            accept();
                          });
  }

  /// Waits before the next accept, for example if no file descriptors are left.
  void wait_to_accept() {
    pause.expires_after(accept_pause);
    pause.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }

  std::unique_ptr<Shared> shared;  // destroyed after the context, which holds the connections
  asio::io_context context;
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  std::vector<std::thread> threads;
};

WebServer::WebServer(const WebOptions& options, WebHandler& handler)
    : state_(std::make_unique<State>(options, handler)) {
  state_->accept();
  for (int i = 0; i < options.threads; ++i)
    state_->threads.emplace_back([this] { state_->context.run(); });
}

WebServer::~WebServer() {
  state_->context.stop();
  for (std::thread& thread : state_->threads) thread.join();
}

std::string WebServer::url() const { return state_->shared->guard.url(); }
std::uint16_t WebServer::port() const { return state_->acceptor.local_endpoint().port(); }

void WebServer::wake() {
  std::vector<std::shared_ptr<Channel>> awake;
  {
    const std::lock_guard lock(state_->shared->channels_mutex);
    for (const auto& weak : state_->shared->channels)
      if (auto channel = weak.lock()) awake.push_back(std::move(channel));
  }
  for (const auto& channel : awake) channel->wake();
}

}  // namespace penumbra::io
