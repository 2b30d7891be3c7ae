#include "traverse/files/shell_word.hpp"

#include <array>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

namespace traverse::files {
namespace {

TEST(ShellWord, IsOneWordForTheShellWhateverItHolds) {
  for (const std::string text :
       {"plain", "", "two words", "it's", "$HOME `date` \\ \"quoted\" * ; &", "'", "line\nbreak"}) {
    const std::string command = "printf '<%s>' " + in_shell_quotes(text);
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    ASSERT_NE(pipe, nullptr);
    std::array<char, 256> buffer{};
    const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
    EXPECT_EQ(std::string(buffer.data(), size), "<" + text + ">");
  }
}

}  // namespace
}  // namespace traverse::files
