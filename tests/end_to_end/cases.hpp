#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::testing {

/// Why a test on the small inputs that went wrong for users is skipped.
inline constexpr const char* kNoCases =
    "the small inputs that went wrong are not there: cases/cases.tar.xz beside the folder that "
    "TRAVERSE_TEST_DATA names";

/// The folder that holds them, a folder each, unpacked once for all tests of the program; empty if
/// there are none.
inline std::filesystem::path cases() {
  static const TemporaryFolder folder;
  static const bool is_there = [] {
    const std::filesystem::path archive = test_data().parent_path() / "cases/cases.tar.xz";
    if (!std::filesystem::exists(archive)) return false;
    const std::string command =
        "tar -C '" + folder.path().string() + "' -xJf '" + archive.string() + "'";
    return std::system(command.c_str()) == 0;
  }();
  return is_there ? folder / "cases" : std::filesystem::path();
}

}  // namespace traverse::testing
