// Downloads from a server on this machine, and the cache.

#include "app/scene/fetch.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "core/error.h"
#include "tests/support/process.h"

namespace meniscus {
namespace {

// Answers requests on the loopback interface, one after the other, until it is destroyed.
class Server {
 public:
  explicit Server(std::map<std::string, std::string> answers) : answers_(std::move(answers)) {
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    const bool listens =
        bind(socket_, any, size) == 0 && listen(socket_, 8) == 0 && getsockname(socket_, any, &size) == 0;
    EXPECT_TRUE(listens);
    base_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { serve(); });
  }
  ~Server() {
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  std::string url(const std::string& path) const { return base_ + path; }
  int requests() const { return requests_; }

 private:
  void serve() {
    for (int client; (client = accept(socket_, nullptr, nullptr)) >= 0; close(client)) {
      std::string request;
      char buffer[4096];
      while (request.find("\r\n\r\n") == std::string::npos) {
        const ssize_t got = read(client, buffer, sizeof buffer);
        if (got <= 0) break;
        request.append(buffer, static_cast<std::size_t>(got));
      }
      ++requests_;
      const std::size_t path = request.find(' ') + 1;
      const auto found = answers_.find(request.substr(path, request.find(' ', path) - path));
      const std::string answer =
          found != answers_.end() ? found->second : "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n";
      EXPECT_EQ(send(client, answer.data(), answer.size(), MSG_NOSIGNAL),
                static_cast<ssize_t>(answer.size()));
    }
  }

  std::map<std::string, std::string> answers_;
  std::string base_;
  std::atomic<int> requests_{0};
  int socket_ = -1;
  std::thread thread_;
};

std::string page(const std::string& body) {
  return "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\n\r\n" + body;
}
std::string moved(const std::string& where) {
  return "HTTP/1.1 302 Found\r\nConnection: close\r\nContent-Length: 0\r\nLocation: " + where + "\r\n\r\n";
}

class Fetch : public testing::Test {
 protected:
  void SetUp() override { setenv("no_proxy", "127.0.0.1", 1); }  // of the system
  static std::string failure(const std::string& url, const std::filesystem::path& cache, bool offline) {
    try {
      fetch(url, cache, offline);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
  const std::string body_ = std::string("ATOM\n\0\x80", 7) + std::string(100000, 'x');
};

TEST_F(Fetch, whatWasFetchedOnceComesFromTheCache) {
  const std::filesystem::path cache = folder_ / "new" / "cache";
  std::string url;
  {
    const Server server({{"/a.pdb", page(body_)}, {"/old.pdb", moved("/a.pdb")}});
    url = server.url("/a.pdb");
    EXPECT_EQ(fetch(url, cache, false), body_);
    EXPECT_EQ(server.requests(), 1);
    EXPECT_EQ(fetch(url, cache, false), body_);
    EXPECT_EQ(server.requests(), 1);
    EXPECT_EQ(fetch(server.url("/old.pdb"), {}, false), body_);
    EXPECT_EQ(fetch(server.url("/old.pdb"), {}, false), body_) << "nothing is kept without a cache";
    EXPECT_EQ(server.requests(), 5);
  }
  EXPECT_EQ(fetch(url, cache, true), body_);
  EXPECT_NE(failure(url, folder_ / "other", true).find("leave out --offline"), std::string::npos);
  EXPECT_NE(failure(url, folder_ / "other", false).find("cannot be fetched"), std::string::npos);
}

TEST_F(Fetch, failuresSayWhyAndAreNotKept) {
  test::writeFile(folder_ / "secret", "secret");
  const Server server({{"/file", moved("file://" + (folder_ / "secret").string())},
                       {"/round", moved("/round")},
                       {"/cut", "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: 10\r\n\r\nhalf"}});
  const std::filesystem::path cache = folder_ / "cache";
  for (const auto& [path, reason] :
       {std::pair{"/missing", "404"}, std::pair{"/file", "cannot be fetched"},
        std::pair{"/round", "redirects"}, std::pair{"/cut", "cannot be fetched"}}) {
    const std::string said = failure(server.url(path), cache, false);
    EXPECT_NE(said.find(reason), std::string::npos) << said;
    EXPECT_NE(said.find(server.url(path)), std::string::npos) << said;
  }
  EXPECT_FALSE(std::filesystem::exists(cache));
}

}  // namespace
}  // namespace meniscus
