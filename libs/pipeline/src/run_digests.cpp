#include "traverse/pipeline/run_digests.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "digest_check.hpp"
#include "next_step.hpp"

namespace traverse::pipeline {

namespace {

namespace fs = std::filesystem;
using files::InputError;
using files::JsonValue;
using files::Place;

constexpr std::size_t kDigitsShown = 12;

const FileDigest* digest_of(const std::vector<FileDigest>& digests, const std::string& name) {
  const auto found = std::find_if(digests.begin(), digests.end(),
                                  [&](const FileDigest& one) { return one.name == name; });
  return found == digests.end() ? nullptr : &*found;
}

bool is_written_anew(const fs::path& file) {
  const RunFolder folder;
  const std::array later{folder.record(), folder.factor_bench(), folder.report(),
                         folder.report_json()};
  return std::find(later.begin(), later.end(), file.filename()) != later.end();
}

std::string in_short(std::uintmax_t bytes, const std::string& sha256) {
  return fmt::format("{} bytes, SHA-256 {}...", bytes, sha256.substr(0, kDigitsShown));
}

std::vector<FileDigest> digests_in(const JsonValue& record) {
  std::vector<FileDigest> digests;
  if (!record.has("files")) return digests;
  const JsonValue list = record["files"];
  for (const std::string& name : list.keys()) {
    digests.push_back({name, list[name]["bytes"].count(), list[name]["sha256"].text()});
  }
  return digests;
}

}  // namespace

void add_digests(const RunFolder& folder, std::vector<FileDigest>& known) {
  for (const fs::path& file : folder.files()) {
    const std::string name = file.filename().string();
    if (is_written_anew(file) || digest_of(known, name) != nullptr || !fs::is_regular_file(file)) {
      continue;
    }
    known.push_back({name, fs::file_size(file), files::sha256_of_file(file)});
  }
}

DigestCheck::DigestCheck(const RunFolder& folder, std::string_view record) {
  has_digests_ = files::require_seal(record, folder.record());
  const auto document = files::JsonDocument::parse(record, folder.record());
  files_ = digests_in(document.root());
  if (has_digests_ || files_.empty()) return;
  throw InputError(folder.record(), Place::key(files::kSealKey),
                   "the digest of run.json, beside those of the other files", "none");
}

void DigestCheck::require(const fs::path& file) const {
  if (!has_digests_ || is_written_anew(file) || !fs::is_regular_file(file)) return;
  const FileDigest* stated = digest_of(files_, file.filename().string());
  if (stated == nullptr) {
    throw InputError(file, Place::whole_file(), "one of the files that run.json says the run wrote",
                     "one that it does not name: it is another run's, or run.json is");
  }
  const auto require_equal = [&](bool is_equal, const std::string& found) {
    if (is_equal) return;
    throw InputError(
        file, Place::whole_file(),
        "the file that run.json says the run wrote, " + in_short(stated->bytes, stated->sha256),
        found + ": it was edited, is damaged or is another run's");
  };
  // The size alone tells most damage, without reading the file.
  const std::uintmax_t bytes = fs::file_size(file);
  require_equal(bytes == stated->bytes, fmt::format("{} bytes", bytes));
  const std::string sha256 = files::sha256_of_file(file);
  require_equal(sha256 == stated->sha256, in_short(bytes, sha256));
}

void require_as_written(const RunFolder& folder, const std::vector<fs::path>& files) {
  if (!fs::exists(folder.record())) return;
  with_next_step([&] {
    const DigestCheck check(folder, files::read_text(folder.record()));
    for (const fs::path& file : files) check.require(file);
  });
}

}  // namespace traverse::pipeline
