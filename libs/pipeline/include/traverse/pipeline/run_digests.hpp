#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace traverse::pipeline {

struct RunFolder;

/// What a file of a run was when the run wrote it.
struct FileDigest {
  std::string name;  ///< in the run folder
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// Adds to `known` the files in the folder that are a run's and not among them yet. Left out are
/// those that later commands write anew: run.json and factor_bench.json, which state their own
/// digest, the pictures and the report, which no command reads.
/// \throws files::InputError for one that cannot be read
void add_digests(const RunFolder& folder, std::vector<FileDigest>& known);

/// That these files are as the run wrote them, as far as its run.json tells: those of versions
/// before 0.2 do not, and a folder without run.json holds no run. What is absent is passed over.
/// \param files of a run, in its folder
/// \throws files::InputError naming the file, and as files::require_seal()
void require_as_written(const RunFolder& folder, const std::vector<std::filesystem::path>& files);

}  // namespace traverse::pipeline
