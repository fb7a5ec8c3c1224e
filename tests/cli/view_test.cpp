// raygrain view: pages written and served, and what it refuses.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

/// A folder with a page that holds nothing but the places for data.
struct ViewFolder {
  TemporaryFolder folder;
  std::string page = folder.file("page.html"), out = folder.file("view.html");

  ViewFolder() { write_file(page, "<!doctype html>@RAYGRAIN_VIEW@|@RAYGRAIN_BLOBS@"); }

  RunResult view(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"view", kSmallScene, "--template", page});
    return run_program(arguments);
  }
};

TEST(View, WritesOnePage) {
  const ViewFolder folder;
  const RunResult result = folder.view({"--recipes", "SAH+LSPH,PAH+ALL", "--out", folder.out});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("1 areas, 2 trees"), std::string::npos) << result.output;
  const std::string page = read_file(folder.out);
  EXPECT_NE(page.find("\"format\":\"raygrain-view\""), std::string::npos);
  EXPECT_NE(page.find("\"recipe\":\"PAH+ALL\""), std::string::npos);
}

TEST(View, RefusesWhatMakesNoSense) {
  const ViewFolder folder;
  EXPECT_EQ(folder.view({}).exit_code, 2) << "neither --out nor --serve";
  EXPECT_EQ(folder.view({"--out", folder.out, "--port", "80"}).exit_code, 2) << "--port without --serve";
  EXPECT_EQ(folder.view({"--out", folder.out, "--recipes", "SAH+NONE"}).exit_code, 2);
  const RunResult none = folder.view({"--template", folder.folder.file("none.html"), "--out", folder.out});
  EXPECT_NE(none.exit_code, 0);
  write_file(folder.page, "<!doctype html>");
  const RunResult foreign = folder.view({"--out", folder.out});
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_NE(foreign.errors.find("is no viewer page of raygrain. Build it again with make viewer"), std::string::npos)
      << foreign.errors;
  EXPECT_FALSE(std::filesystem::exists(folder.out));
}

TEST(View, NeedsAreasForRecipesOfAreas) {
  const ViewFolder folder;
  write_file(folder.folder.file("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const RunResult result = run_program(
      {"view", folder.folder.file("one.obj"), "--template", folder.page, "--recipes", "PAH+ALL", "--out", folder.out});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("'PAH+ALL' needs an area and there is none"), std::string::npos) << result.errors;
  const RunResult whole =
      run_program({"view", folder.folder.file("one.obj"), "--template", folder.page, "--out", folder.out});
  EXPECT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_NE(read_file(folder.out).find("\"area\":-1"), std::string::npos);
}

/// What a server of this machine answers.
std::string asked(int port, const std::string& request) {
  const int handle = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  std::string answer;
  if (::connect(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    EXPECT_EQ(::send(handle, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
    char buffer[4096];
    for (ssize_t count = 0; (count = ::recv(handle, buffer, sizeof buffer, 0)) > 0;)
      answer.append(buffer, static_cast<size_t>(count));
  }
  ::close(handle);
  return answer;
}

TEST(View, ServesThePageUntilInterrupted) {
  const ViewFolder folder;
  const std::string output = folder.folder.file("output"), errors = folder.folder.file("errors");
  RunningProgram program({"view", kSmallScene, "--template", folder.page, "--serve"}, output, errors);
  const std::string sign = "http://127.0.0.1:";
  std::string said;
  for (int i = 0; i < 600 && said.find(sign) == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    said = read_file(output);
  }
  const size_t at = said.find(sign);
  ASSERT_NE(at, std::string::npos) << said << read_file(errors);
  const int port = std::stoi(said.substr(at + sign.size()));
  const std::string page = asked(port, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 OK\r\n")) << page.substr(0, 100);
  EXPECT_NE(page.find("raygrain-view"), std::string::npos);
  EXPECT_TRUE(asked(port, "GET /etc/passwd HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 404"));
  const std::string head = asked(port, "HEAD / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(head.starts_with("HTTP/1.1 200") && head.ends_with("\r\n\r\n")) << head.substr(0, 300);
  const RunResult second = folder.view({"--serve", "--port", std::to_string(port)});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.errors.find("Choose another one with --port"), std::string::npos) << second.errors;
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 128 + SIGINT);
}

}  // namespace
}  // namespace raygrain::test
