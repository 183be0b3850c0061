// SPDX-License-Identifier: Apache-2.0
// The server alone: what it refuses, and what clients that behave badly cost the others.
#include "../support/errors.hpp"
#include "../support/process_memory.hpp"
#include "../support/run_length.hpp"
#include "web_client.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <io/web/web_server.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t large_bytes = std::size_t{8} << 20U;

/// Answers each request with what was asked for; /large is large; "/say" is a channel that repeats
/// what it is told, and says "wake" when it is woken.
class Echo final : public io::WebHandler {
 public:
  class Channel final : public io::WebChannel {
   public:
    explicit Channel(const std::atomic<int>& wakes) : wakes_(wakes), seen_(wakes) {}
    bool take(std::string_view text) override {
      if (text == "bad") return false;
      said_ = text;
      return true;
    }
    std::optional<std::vector<io::SharedBytes>> next() override {
      if (const auto said = std::exchange(said_, std::nullopt))
        return std::vector{io::shared_bytes("you said "), io::shared_bytes(*said)};
      const int now = wakes_;
      if (std::exchange(seen_, now) == now) return std::nullopt;
      return std::vector{io::shared_bytes("wake")};
    }

   private:
    const std::atomic<int>& wakes_;
    int seen_;
    std::optional<std::string> said_;
  };

  io::WebAnswer answer(const io::WebRequest& request) override {
    if (request.path == "/large")
      return {.body = {io::shared_bytes(std::string(large_bytes, 'x'))}};
    if (request.path == "/bug") throw std::runtime_error("a \"bug\"");
    std::string text = request.path;
    for (const auto& [name, value] : request.query)
      text.append(" ").append(name).append("=").append(value);
    return {.type = "text/plain", .body = {io::shared_bytes(text)}};
  }
  std::unique_ptr<io::WebChannel> open_channel(const std::string& path) override {
    return path == "/say" ? std::make_unique<Channel>(wakes) : nullptr;
  }

  std::atomic<int> wakes = 0;
};

class ServerTest : public testing::Test {
 protected:
  WebClient client() { return WebClient(server_.port()); }
  WebClient talker() {
    WebClient one = client();
    EXPECT_EQ(one.upgrade("/say").status, 101);
    return one;
  }
  [[nodiscard]] std::string host() const {
    return "Host: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  }

  Echo echo_;
  io::WebServer server_{{}, echo_};
};

TEST_F(ServerTest, AnswersOneRequestAfterAnother) {
  WebClient one = client();
  EXPECT_EQ(one.get("/a").body, "/a");
  const HttpReply reply = one.get("/b%20c?x=1%2C2&y");
  EXPECT_EQ(reply.body, "/b c x=1,2 y=");
  EXPECT_EQ(reply.headers.at("content-type"), "text/plain");
  EXPECT_EQ(reply.headers.at("x-content-type-options"), "nosniff");
  EXPECT_NE(reply.headers.at("content-security-policy").find("default-src 'self'"),
            std::string::npos);
  const HttpReply bug = one.get("/bug");
  EXPECT_EQ(bug.status, 500);
  EXPECT_EQ(bug.body, "{\"error\":\"a \\\"bug\\\"\"}\n");
}

TEST_F(ServerTest, ForeignHostsAreRefused) {
  const std::string port = ":" + std::to_string(server_.port());
  for (const std::string& host :
       {"evil.example" + port, std::string("127.0.0.1"), std::string("localhost:1"),
        "127.0.0.1.evil.example" + port, "192.168.0.1" + port, std::string("x")})
    EXPECT_EQ(client().get("/", "", host).status, 403) << host;
  for (const std::string& host : {"localhost" + port, "LocalHost" + port, "[::1]" + port})
    EXPECT_EQ(client().get("/", "", host).status, 200) << host;
  WebClient none = client();
  none.send("GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(none.reply().status, 400);
  EXPECT_EQ(client().get("/", "Host: localhost" + port + "\r\n").status, 400) << "two";
}

TEST_F(ServerTest, ForeignOriginsAreRefused) {
  const std::string own = "http://127.0.0.1:" + std::to_string(server_.port());
  EXPECT_EQ(client().get("/", "Origin: " + own + "\r\n").status, 200);
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), own + "0", "https" + own.substr(4),
        "http://localhost:" + std::to_string(server_.port())}) {
    EXPECT_EQ(client().get("/", "Origin: " + origin + "\r\n").status, 403) << origin;
    EXPECT_EQ(client().upgrade("/say", "Origin: " + origin + "\r\n").status, 403) << origin;
  }
  EXPECT_EQ(client().upgrade("/say", "Origin: " + own + "\r\n").status, 101);
}

TEST_F(ServerTest, OtherMethodsAreRefused) {
  for (const char* const method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
    WebClient one = client();
    one.send(method + std::string(" / HTTP/1.1\r\n") + host() + "Content-Length: 0\r\n\r\n");
    EXPECT_EQ(one.reply().status, 405) << method;
  }
  WebClient one = client();
  one.send("POST / HTTP/1.1\r\n" + host() + "Content-Length: 3\r\n\r\nabc");
  EXPECT_EQ(one.reply().status, 413);
  EXPECT_TRUE(one.is_closed());
}

TEST_F(ServerTest, OversizedAndMalformedRequestsAreRefused) {
  WebClient large = client();
  EXPECT_EQ(large.get("/" + std::string(9000, 'x')).status, 431);
  EXPECT_TRUE(large.is_closed());
  EXPECT_EQ(client().get("/", "X: " + std::string(9000, 'x') + "\r\n").status, 431);
  for (const std::string text :
       {"hello\r\n\r\n", "GET  / HTTP/1.1\r\n\r\n", "GET / HTTP/3.7\r\n\r\n",
        "GET / HTTP/1.1\r\nHost\r\n\r\n", "\x16\x03\x01\x02\x00\x01\xfc\x03\r\n\r\n"}) {
    WebClient one = client();
    one.send(text);
    EXPECT_EQ(one.reply().status, 400) << text;
    EXPECT_TRUE(one.is_closed());
  }
  for (const std::string target : {"/%", "/%4", "/%zz", "/%00", "/a%0d%0ab", "*", "http://x/"})
    EXPECT_EQ(client().get(target).status, 400) << target;
}

TEST_F(ServerTest, BadWebSocketFramesCloseTheirConnectionAlone) {
  WebClient good = talker();
  const auto status_of = [&](auto send) {
    WebClient one = talker();
    send(one);
    const auto message = one.message();
    if (!message || message->opcode != 8 || message->payload.size() < 2) return 0;
    return static_cast<unsigned char>(message->payload[0]) << 8 |
           static_cast<unsigned char>(message->payload[1]);
  };
  EXPECT_EQ(status_of([](WebClient& c) { c.send_text("bad"); }), 1008);
  EXPECT_EQ(status_of([](WebClient& c) { c.send_frame(2, "binary"); }), 1003);
  EXPECT_EQ(status_of([](WebClient& c) { c.send_text(std::string(5000, 'x')); }), 1009);
  EXPECT_EQ(status_of([](WebClient& c) { c.send_frame(3, "reserved"); }), 1002);
  EXPECT_EQ(status_of([](WebClient& c) { c.send_text("\xff\xfe"); }), 1007);
  EXPECT_EQ(status_of([](WebClient& c) { c.send("\x81\x05hello"); }), 1002);  // not masked
  good.send_text("still here");
  EXPECT_EQ(good.message()->payload, "you said still here");
}

TEST(ServerAddress, WhatCannotBeListenedOnIsTheUsersFault) {
  Echo echo;
  const io::WebServer first({}, echo);
  EXPECT_THROW(io::WebServer({.port = first.port()}, echo), InputError);
  const io::WebServer next(
      {.port = first.port(), .last_port = static_cast<std::uint16_t>(first.port() + 50)}, echo);
  EXPECT_GT(next.port(), first.port());
  EXPECT_THROW(io::WebServer({.address = "nowhere"}, echo), InputError);
  // Of RFC 5737, for documentation: no machine has it.
  expect_refused([&] { io::WebServer({.address = "192.0.2.1"}, echo); },
                 {"--address 192.0.2.1", "127.0.0.1"});
}

TEST(ServerToken, IsWantedWhereMoreThanTheLoopbackIsServed) {
  Echo echo;
  const io::WebServer server({.address = "0.0.0.0"}, echo);
  const std::string url = server.url();
  const auto at = url.find("/?token=");
  ASSERT_NE(at, std::string::npos) << url;
  const std::string token = url.substr(at + 8);
  EXPECT_EQ(token.size(), 32U);

  WebClient one(server.port());
  EXPECT_EQ(one.get("/a").status, 401);
  EXPECT_EQ(one.get("/a?token=" + token.substr(1)).status, 401);
  EXPECT_EQ(one.get("/a?token=").status, 401);
  EXPECT_EQ(one.upgrade("/say").status, 401);
  EXPECT_EQ(
      one.get("/a?token=" + token, "", "evil.example:" + std::to_string(server.port())).status,
      403);
  const HttpReply admitted = one.get("/a?token=" + token);
  EXPECT_EQ(admitted.status, 303);
  for (const char* path : {"/a", "//evil.example/", "/%5cevil.example/", "/%5C/evil.example"})
    EXPECT_EQ(one.get(path + ("?token=" + token)).headers.at("location"), "/") << path;
  const std::string cookie = admitted.headers.at("set-cookie");
  EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict"), std::string::npos) << cookie;
  const std::string shown = "Cookie: other=1; " + cookie.substr(0, cookie.find(';')) + "\r\n";
  EXPECT_EQ(one.get("/a", shown).body, "/a");
  WebClient user(server.port());
  EXPECT_EQ(user.upgrade("/say", shown).status, 101);

  // Those without the token take no place of those who have it.
  std::vector<WebClient> strangers;
  for (int i = 0; i < 400; ++i) {
    strangers.emplace_back(server.port());
    if (i % 2 == 0) strangers.back().send("GET /a HTTP/1.1\r\n");
  }
  EXPECT_EQ(WebClient(server.port()).get("/a", shown).body, "/a");
  user.send_text("still here");
  EXPECT_EQ(user.message()->payload, "you said still here");
}

// Each asks for 8 MB and takes nothing: unbounded, that would be 1.6 GB.
TEST(SlowClients, CostNoMemoryAndHoldNobodyUp) {
  constexpr std::size_t waiting = 64;  // MiB
  // Sanitizers make each answer slow to make.
  constexpr int count = sanitized ? 40 : 200;
  const double before = memory_of().resident;
  Echo echo;
  const io::WebServer server({.max_waiting_bytes = waiting << 20U}, echo);
  const std::string host = "Host: 127.0.0.1:" + std::to_string(server.port());
  std::vector<WebClient> slow;
  for (int i = 0; i < count; ++i) {
    slow.emplace_back(server.port(), 4096);
    slow.back().send("GET /large HTTP/1.1\r\n" + host + "\r\n\r\n");
  }
  WebClient good(server.port());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(good.get("/a").body, "/a");
  EXPECT_EQ(good.get("/large").body.size(), large_bytes);
  // The waiting answers, those being made, and what the allocator keeps of both.
  if (!sanitized) {
    EXPECT_LT(memory_of().resident, before + 6.0 * waiting);
  }
}

TEST_F(ServerTest, HalfRequestsAndIdleWebSocketsLockNobodyOut) {
  WebClient user = client();
  EXPECT_EQ(user.get("/a").status, 200);
  std::vector<WebClient> idle;
  for (int i = 0; i < 300; ++i) {
    idle.push_back(client());
    idle.back().send("GET / HTTP/1.1\r\nHost: 127.");
  }
  EXPECT_EQ(client().get("/a").status, 200);
  EXPECT_EQ(user.get("/a").status, 200);
  idle.clear();
  for (int i = 0; i < 300; ++i) idle.push_back(talker());
  EXPECT_EQ(client().get("/a").status, 200);
  EXPECT_EQ(client().upgrade("/say").status, 101);
}

TEST(ServerHurry, ThoseThatDoNotAskLoseTheirPlace) {
  Echo echo;
  const io::WebServer server({.max_connections = 4, .request_time = 1s}, echo);
  std::vector<WebClient> idle;
  for (int i = 0; i < 4; ++i) idle.emplace_back(server.port());
  idle.front().send("GET / HTTP/1.1\r\nHost: 127.");
  for (WebClient& one : idle) EXPECT_TRUE(one.is_closed());
  EXPECT_EQ(WebClient(server.port()).get("/a").status, 200);
}

TEST_F(ServerTest, ManyClientsAtATimeAreServed) {
  std::vector<std::thread> threads;
  threads.reserve(8);
  std::atomic<int> right = 0;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      WebClient one = client(), talk = talker();
      for (int k = 0; k < 30; ++k) {
        right += one.get("/x").body == "/x" ? 1 : 0;
        talk.send_text("k");
        const auto said = talk.message();
        right += said && (said->payload == "you said k" || said->payload == "wake") ? 1 : 0;
        server_.wake();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 8 * 30 * 2);
}

}  // namespace
}  // namespace penumbra::test
