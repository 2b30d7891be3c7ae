#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace traverse::render {
namespace {

/// What print_digest prints with `threads` OpenGL threads.
std::string digests(int threads) {
  const std::string command =
      "LP_NUM_THREADS=" + std::to_string(threads) + " " TRAVERSE_PRINT_DIGEST;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string text;
  std::array<char, 256> piece{};
  while (pipe && std::fgets(piece.data(), static_cast<int>(piece.size()), pipe.get()) != nullptr) {
    text += piece.data();
  }
  return text;
}

TEST(RendererThreads, TheirNumberDoesNotChangeAByte) {
  const std::string one = digests(1);
  ASSERT_EQ(one.size(), 2 * 65U);
  EXPECT_EQ(one.substr(0, 65), one.substr(65));  // here and in a worker thread
  EXPECT_EQ(digests(4), one);
  EXPECT_EQ(digests(0), one);
}

}  // namespace
}  // namespace traverse::render
