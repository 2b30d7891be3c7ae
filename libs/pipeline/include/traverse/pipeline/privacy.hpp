#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::pipeline {

/// Takes out of results what tells whose machine made them: absolute paths, its name, its
/// processor.
class Privacy {
 public:
  /// \param place folder from which paths are told: that of the run
  explicit Privacy(const std::filesystem::path& place);

  /// The path from `place`; its last name alone where that way would lead through the root of the
  /// file system, above the user's home, or name the user or the machine. A relative path is as it
  /// was.
  std::string path(const std::filesystem::path& path) const;

  /// The text with every absolute path in it told like that.
  std::string text(std::string_view text) const;
  std::vector<std::string> texts(const std::vector<std::string>& texts) const;

  /// run.json with all its texts told like that, and without name and processor of the host.
  /// \param json of a run \throws files::InputError if it is no JSON
  std::string record(std::string_view json) const;

 private:
  std::filesystem::path place_;
  std::filesystem::path home_;
  std::vector<std::string> names_;  ///< of the user and of the machine
};

}  // namespace traverse::pipeline
