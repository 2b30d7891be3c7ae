#include "run_replacement.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/work_folder.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

namespace {

/// Of a run that went to its end, however far it can be believed.
bool is_complete(const std::string& status) {
  return status == "ok" || status == "degraded" || status == "lost";
}

namespace fs = std::filesystem;
using FoundFolder = FoundInPlace::Kind;

constexpr std::uintmax_t kLargestRecord = 64'000'000;  // bytes; those of runs have 100 kB
constexpr int kDeepestValue = 8;

/// The status of a record that this program wrote; empty if it did not.
std::string status_in(const fs::path& record) {
  std::error_code failure;
  if (!fs::is_regular_file(record, failure)) return {};
  if (fs::file_size(record, failure) > kLargestRecord || failure) return {};
  std::ifstream stream(record);
  const auto json = nlohmann::json::parse(
      stream, [](int depth, auto, auto&) { return depth <= kDeepestValue; }, false);
  if (!json.is_object()) return {};
  const auto is = [&](const char* key, auto type) {
    const auto found = json.find(key);
    return found != json.end() && found->type() == type;
  };
  using Type = nlohmann::json::value_t;
  const bool complete = is("status", Type::string) && is("pipeline", Type::string) &&
                        is("recording", Type::object) && is("program", Type::object);
  if (!complete) return {};
  auto status = json.at("status").get<std::string>();
  const bool is_status = is_complete(status) || status == "failed" || status == "interrupted";
  return is_status ? status : std::string();
}

bool is_folder(const fs::path& path) {
  std::error_code failure;
  return fs::is_directory(fs::symlink_status(path, failure));
}

bool is_there(const fs::path& path) {
  std::error_code failure;
  return fs::exists(fs::symlink_status(path, failure));
}

/// The name of a file of which a killed process left this: ".run.json.traverse-4711-0.partial", or
/// ".run.json.4711.partial" of earlier versions. Empty if it is none.
std::string finished_name(std::string_view name) {
  constexpr std::string_view kEnd = ".partial";
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return {};
  name.remove_prefix(1);
  name.remove_suffix(kEnd.size());
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  const std::string_view maker = name.substr(dot + 1);
  const bool is_maker = maker.find_first_not_of("traverse-0123456789") == std::string_view::npos;
  return is_maker ? std::string(name.substr(0, dot)) : std::string();
}

bool is_own_file(const RunFolder& folder, const std::string& name) {
  if (name == folder.report_work().filename()) return true;
  const std::string finished = finished_name(name);
  const auto files = folder.files();
  return std::any_of(files.begin(), files.end(), [&](const fs::path& file) {
    return name == file.filename() || finished == file.filename();
  });
}

bool is_own_picture(const std::string& name) {
  return RunFolder::is_picture(name) || RunFolder::is_picture(finished_name(name));
}

std::string listed(const fs::path& folder) {
  constexpr std::size_t kMostNames = 3;
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    names.push_back(files::in_quotes(entry.path().filename().string()));
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (std::size_t k = 0; k < std::min(kMostNames, names.size()); ++k) {
    text += (k > 0 ? ", " : "") + names[k];
  }
  if (names.size() > kMostNames) text += fmt::format(" and {} more", names.size() - kMostNames);
  return text;
}

[[noreturn]] void fail(const fs::path& path, int error) {
  throw files::OutputError(path, std::strerror(error));
}

void copy_one(const fs::path& from, const fs::path& to, int why_not_linked) {
  std::error_code failure;
  const auto status = fs::symlink_status(from, failure);
  if (fs::is_symlink(status)) {
    fs::copy_symlink(from, to, failure);
  } else if (fs::is_regular_file(status)) {
    fs::copy_file(from, to, failure);
    if (!failure) fs::last_write_time(to, fs::last_write_time(from), failure);
  } else {
    fail(from, why_not_linked);
  }
  if (failure) throw files::OutputError(to, failure.message());
}

void carry_over(const fs::path& from, const fs::path& to) {
  if (!is_folder(from)) {
    if (is_there(to)) return;
    if (::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), 0) == 0) return;
    copy_one(from, to, errno);
    return;
  }
  std::error_code failure;
  const bool is_new = !is_there(to);
  if (is_new) fs::create_directory(to, failure);
  if (failure) throw files::OutputError(to, failure.message());
  if (!is_folder(to)) return;
  for (const auto& entry : fs::directory_iterator(from, failure)) {
    carry_over(entry.path(), to / entry.path().filename());
  }
  if (failure) throw files::OutputError(from, failure.message());
  if (!is_new) return;
  fs::permissions(to, fs::status(from, failure).permissions(), failure);
  fs::last_write_time(to, fs::last_write_time(from, failure), failure);
}

/// Who may read a run may read the one that replaces it.
void take_permissions(const fs::path& from, const fs::path& to) {
  struct stat status {};
  if (::stat(from.c_str(), &status) != 0) return;
  // Where the group cannot be given away it stays as the system chose it.
  [[maybe_unused]] const int chosen = ::chown(to.c_str(), static_cast<uid_t>(-1), status.st_gid);
  ::chmod(to.c_str(), status.st_mode & 07777U);
}

/// As some file systems (FUSE, NFS) say it.
bool cannot_exchange(int error) {
  return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP;
}

/// \returns where the earlier run is now
const fs::path& exchange_names(const fs::path& made, const fs::path& place, const fs::path& aside,
                               Exchange exchange) {
  if (exchange == Exchange::kAtOnce) {
    const bool done =
        ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0;
    if (done) return made;
    if (!cannot_exchange(errno)) fail(place, errno);
  }
  if (::rename(place.c_str(), aside.c_str()) != 0) fail(place, errno);
  if (::rename(made.c_str(), place.c_str()) == 0) return aside;
  const int error = errno;
  ::rename(aside.c_str(), place.c_str());
  fail(place, error);
}

}  // namespace

FoundInPlace look_at_place(const fs::path& folder) {
  std::error_code failure;
  if (!is_there(folder)) return {};
  if (!fs::is_directory(folder, failure)) return {FoundFolder::kForeign, "it is not a folder"};
  const bool empty = fs::is_empty(folder, failure);
  if (failure) return {FoundFolder::kForeign, failure.message()};
  if (empty) return {};
  const RunFolder run{folder};
  const std::string status = status_in(run.record());
  if (status.empty()) {
    return {FoundFolder::kForeign,
            fmt::format("it is not an earlier run: it holds {} and no run.json of a run",
                        listed(folder))};
  }
  for (const fs::path& file : run.files()) {
    if (is_folder(file)) {
      return {FoundFolder::kForeign, fmt::format("{} in it is a folder", file.filename().string())};
    }
  }
  if (is_there(run.images()) && !is_folder(run.images())) {
    return {FoundFolder::kForeign, "images in it is not a folder"};
  }
  const bool has_poses = is_there(run.trajectory());
  return {has_poses ? FoundFolder::kRun : FoundFolder::kNoPoses, "", is_complete(status)};
}

void carry_over_foreign(const fs::path& from, const fs::path& to) {
  const RunFolder run{from};
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(from, failure)) {
    const std::string name = entry.path().filename().string();
    if (is_own_file(run, name) || entry.path() == run.images()) continue;
    carry_over(entry.path(), to / name);
  }
  if (failure) throw files::OutputError(from, failure.message());
  if (!is_folder(run.images())) return;
  const fs::path images = RunFolder{to}.images();
  for (const auto& entry : fs::directory_iterator(run.images(), failure)) {
    const std::string name = entry.path().filename().string();
    if (is_own_picture(name) && !is_folder(entry.path())) continue;
    fs::create_directory(images, failure);
    if (failure) throw files::OutputError(images, failure.message());
    carry_over(entry.path(), images / name);
  }
  if (failure) throw files::OutputError(run.images(), failure.message());
}

void replace_run(const fs::path& made, const fs::path& place, const fs::path& aside,
                 Exchange exchange) {
  take_permissions(place, made);
  if (::rename(made.c_str(), place.c_str()) == 0) return;  // nothing there, or an empty folder
  if (errno != ENOTEMPTY && errno != EEXIST) fail(place, errno);
  // What `report` is just making there would end up among this run's files.
  files::WorkFolder no_report(RunFolder{place}.report_work(), place,
                              files::WorkFolder::Others::kWaitFor);
  carry_over_foreign(place, made);
  no_report.keep(true);  // it goes with the earlier run: its name will be another's
  try {
    const fs::path& earlier = exchange_names(made, place, aside, exchange);
    carry_over_foreign(earlier, place);  // what came meanwhile
    files::remove_tree(earlier);
  } catch (...) {
    no_report.keep(false);
    throw;
  }
}

void recover_replacement(const fs::path& made, const fs::path& place, const fs::path& aside) {
  if (!is_there(aside)) return;
  if (look_at_place(place).kind == FoundFolder::kNothing) {
    const bool is_complete = !status_in(RunFolder{made}.record()).empty();
    const fs::path& latest = is_complete ? made : aside;
    if (::rename(latest.c_str(), place.c_str()) != 0) fail(place, errno);
  }
  if (!is_there(aside)) return;
  carry_over_foreign(aside, place);
  files::remove_tree(aside);
}

}  // namespace traverse::pipeline
