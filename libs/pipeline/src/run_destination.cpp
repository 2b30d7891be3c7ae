#include "traverse/pipeline/run_destination.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/work_folder.hpp"

#include "run_replacement.hpp"

namespace traverse::pipeline {

namespace {

namespace fs = std::filesystem;
using Found = FoundInPlace::Kind;

constexpr int kMostBeside = 1000;

fs::path without_links(const fs::path& path) {
  std::error_code failure;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path), failure);
  if (failure) throw files::OutputError(path, failure.message());
  return whole.has_filename() ? whole : whole.parent_path();
}

/// A folder that is the root of a mounted file system cannot be renamed.
bool is_mount_point(const fs::path& path) {
  struct statx status {};
  if (::statx(AT_FDCWD, path.c_str(), 0, STATX_TYPE, &status) != 0) return false;
  return (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

bool is_in_or_at(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end();
}

void require_replaceable(const fs::path& given, const fs::path& folder) {
  const FoundInPlace found = look_at_place(folder);
  if (found.kind == Found::kForeign) {
    throw files::OutputError(
        given, found.text +
                   ". Nothing was changed; give an empty folder, one that is not there yet, or an "
                   "earlier run with -o");
  }
  std::error_code failure;
  if (!fs::exists(folder, failure)) {
    if (fs::is_symlink(fs::symlink_status(folder, failure))) {
      throw files::OutputError(given, "it is a link to a folder that is not there");
    }
    return;
  }
  if (is_mount_point(folder)) {
    throw files::OutputError(
        given, fmt::format("it is a mount point, which no complete run can replace at once; give a "
                           "folder in it: -o {}",
                           (given / "run").string()));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw files::OutputError(given, "it is read-only");
  }
}

}  // namespace

fs::path RunDestination::work_folder(const fs::path& folder) {
  return folder.parent_path() / fmt::format(".{}.traverse-work", folder.filename().string());
}

RunDestination::RunDestination(fs::path given, const std::vector<Input>& inputs)
    : given_(given.has_filename() ? std::move(given) : given.parent_path()),
      folder_(without_links(given_)),
      made_{work_folder(folder_) / "run"} {
  for (const Input& input : inputs) {
    if (is_in_or_at(without_links(input.path), folder_)) {
      throw files::OutputError(
          given_, fmt::format("{}, {}, is there. Nothing was changed; give another folder with -o",
                              input.what, input.path.string()));
    }
  }
  require_replaceable(given_, folder_);
}

RunDestination::~RunDestination() = default;

RunFolder RunDestination::begin() {
  std::error_code failure;
  fs::create_directories(folder_.parent_path(), failure);
  if (failure) throw files::OutputError(given_, failure.message());
  work_ = std::make_unique<files::WorkFolder>(work_folder(folder_), given_);
  recover_replacement(made_.path, folder_, work_->path() / "earlier");
  work_->clear();
  require_replaceable(given_, folder_);  // it may have changed before the lock was held
  fs::create_directory(made_.path, failure);
  if (failure) throw files::OutputError(given_, failure.message());
  return made_;
}

bool RunDestination::has_earlier_run() const { return look_at_place(folder_).kind == Found::kRun; }

fs::path RunDestination::beside(int number) const {
  const fs::path name = given_.filename();
  const fs::path& shown = name.empty() || name == "." || name == ".." ? folder_ : given_;
  return shown.string() + ".interrupted" + (number > 1 ? fmt::format(".{}", number) : "");
}

fs::path RunDestination::place(Outcome outcome, bool force) const {
  const Found found = look_at_place(folder_).kind;
  const bool may_replace = outcome == Outcome::kComplete || force;
  if (found == Found::kNothing || found == Found::kNoPoses) return given_;
  if (found == Found::kRun && may_replace) return given_;
  return free_place_beside();
}

fs::path RunDestination::free_place_beside() const {
  for (int number = 1; number < kMostBeside; ++number) {
    const FoundInPlace there = look_at_place(beside(number));
    if (there.kind != Found::kForeign && !there.is_complete) return beside(number);
  }
  throw files::OutputError(beside(1), "something is in each folder of such a name");
}

RunFolder RunDestination::finish(Outcome outcome, bool force) {
  fs::path shown = place(outcome, force);
  if (shown == given_) {
    try {
      give_name(folder_, given_);
      return {given_};
    } catch (const files::OutputError& error) {
      why_beside_ = error.what();  // rather beside its place than lost
      shown = free_place_beside();
    }
  }
  give_name(without_links(shown), shown);
  return {shown};
}

void RunDestination::give_name(const fs::path& folder, const fs::path& shown) {
  // Somebody's own run may be on its way to the other name.
  std::unique_ptr<files::WorkFolder> other;
  if (folder != folder_) other = std::make_unique<files::WorkFolder>(work_folder(folder), shown);
  const fs::path earlier = work_->path() / "earlier";
  work_->keep(true);  // for a moment an earlier run may be in it
  try {
    replace_run(made_.path, folder, earlier);
  } catch (...) {
    work_->keep(fs::exists(earlier));
    throw;
  }
  work_->keep(false);
  work_.reset();
}

std::string RunDestination::in_words(std::string text, const fs::path& place) const {
  const std::string made = made_.path.string();
  for (std::size_t at = 0; (at = text.find(made, at)) != std::string::npos;) {
    text.replace(at, made.size(), place.string());
    at += place.string().size();
  }
  return text;
}

}  // namespace traverse::pipeline
