#include "traverse/files/work_folder.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/unfinished.hpp"

namespace traverse::files {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "lock";

/// "process 4711 on host since 2026-11-30 10:15:30 UTC"
std::string this_owner() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
  return fmt::format("process {} on {} since {}", ::getpid(), host.data(), text.data());
}

std::string owner_in(int lock) {
  std::array<char, 512> text{};
  const ssize_t size = ::pread(lock, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "another process";
}

/// Whether the file is still the one of this name: who held the lock before may have removed it.
bool still_has_its_name(int lock, const fs::path& file) {
  struct stat held {};
  struct stat named {};
  return ::fstat(lock, &held) == 0 && ::stat(file.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

/// Not every file system has locks (some cluster file systems are mounted without); there a second
/// process is not noticed, which is no reason to refuse the first.
bool has_no_locks(int error) {
  return error == ENOSYS || error == ENOLCK || error == EOPNOTSUPP || error == EINVAL;
}

/// \returns the descriptor that holds the lock, or -1 if the folder went away meanwhile.
int try_lock(const fs::path& folder, const fs::path& result, WorkFolder::Others others) {
  if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) {
    throw OutputError(result,
                      fmt::format("{} cannot be made: {}", folder.string(), std::strerror(errno)));
  }
  const fs::path file = folder / kLockName;
  const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock < 0) {
    if (errno == ENOENT) return -1;
    throw OutputError(result,
                      fmt::format("{} cannot be opened: {}", file.string(), std::strerror(errno)));
  }
  const int refuse = others == WorkFolder::Others::kRefuse ? LOCK_NB : 0;
  int error = 0;
  while (::flock(lock, LOCK_EX | refuse) != 0) {
    error = errno;
    if (error != EINTR) break;
    error = 0;
  }
  if (error == EWOULDBLOCK) {
    const std::string owner = owner_in(lock);
    ::close(lock);
    throw FolderInUse(
        fmt::format("{}: {} is writing it; wait until it is through", result.string(), owner));
  }
  if (error != 0 && !has_no_locks(error)) {
    ::close(lock);
    throw OutputError(result, fmt::format("{}: {}", file.string(), std::strerror(error)));
  }
  if (still_has_its_name(lock, file)) return lock;
  ::close(lock);
  return -1;
}

/// A folder that may not be written cannot be emptied either.
void make_folders_writable(const fs::path& path) {
  std::error_code ignored;
  fs::permissions(path, fs::perms::owner_all, fs::perm_options::add, ignored);
  for (const auto& entry : fs::directory_iterator(path, ignored)) {
    if (entry.is_directory(ignored) && !entry.is_symlink(ignored)) {
      make_folders_writable(entry.path());
    }
  }
}

}  // namespace

void remove_tree(const fs::path& path) {
  std::error_code failure;
  fs::remove_all(path, failure);
  if (!failure) return;
  if (fs::is_directory(fs::symlink_status(path, failure))) make_folders_writable(path);
  fs::remove_all(path, failure);
  if (failure) throw OutputError(path, "it cannot be removed: " + failure.message());
}

WorkFolder::WorkFolder(fs::path path, fs::path result, Others others)
    : path_(std::move(path)), result_(std::move(result)) {
  while (lock_ < 0) lock_ = try_lock(path_, result_, others);
  const std::string owner = this_owner();
  // Who it is, for messages to others; the lock holds without it.
  if (::ftruncate(lock_, 0) == 0) {
    [[maybe_unused]] const ssize_t written = ::write(lock_, owner.data(), owner.size());
  }
}

WorkFolder::~WorkFolder() {
  if (!keep_) {
    try {
      clear();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): the next process clears it
    }
    std::error_code ignored;
    fs::remove(path_ / kLockName, ignored);
    fs::remove(path_, ignored);  // if nothing is in it
  }
  unfinished_.reset();
  ::close(lock_);
}

void WorkFolder::clear() {
  if (unfinished_ == nullptr && !keep_) unfinished_ = std::make_unique<Unfinished>(path_);
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(path_, failure)) {
    if (entry.path().filename() != kLockName) remove_tree(entry.path());
  }
  if (failure) throw OutputError(result_, path_.string() + ": " + failure.message());
}

void WorkFolder::keep(bool keep) {
  keep_ = keep;
  unfinished_ = keep ? nullptr : std::make_unique<Unfinished>(path_);
}

}  // namespace traverse::files
