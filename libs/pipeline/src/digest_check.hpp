#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

/// Holds files of a run against the digests that its run.json states.
class DigestCheck {
 public:
  /// \param record the text of run.json
  /// \throws files::InputError if it is not as it was written
  DigestCheck(const RunFolder& folder, std::string_view record);

  /// Nothing for a file that is not there, and if run.json states no digests.
  /// \throws files::InputError naming the file
  void require(const std::filesystem::path& file) const;

 private:
  bool has_digests_ = false;
  std::vector<FileDigest> files_;
};

}  // namespace traverse::pipeline
