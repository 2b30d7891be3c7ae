#include "temporary.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".traverse-";
constexpr std::string_view kEnd = ".partial";
constexpr std::size_t kLongestStem = 200;  // of the 255 bytes that a name may have

bool is_number(std::string_view text) {
  return !text.empty() && text.size() < 20 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Whether a name is one that Temporary gives: ".NAME.traverse-4711-0.partial".
bool is_temporary_name(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return false;
  name.remove_suffix(kEnd.size());
  const std::size_t mark = name.rfind(kMark);
  if (mark == std::string_view::npos || mark < 2) return false;
  const std::string_view numbers = name.substr(mark + kMark.size());
  const std::size_t dash = numbers.find('-');
  return dash != std::string_view::npos && is_number(numbers.substr(0, dash)) &&
         is_number(numbers.substr(dash + 1));
}

/// Whether `path` is still what `descriptor` was opened for.
bool has_name(int descriptor, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Removes it if nobody holds its lock. Where the system has no locks it stays.
void remove_if_abandoned(const fs::path& path) {
  constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  int descriptor = ::open(path.c_str(), O_RDWR | kFlags);  // NFS locks only what may be written
  if (descriptor < 0) descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | kFlags);
  if (descriptor < 0) return;
  std::error_code ignored;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && has_name(descriptor, path)) {
    fs::remove_all(path, ignored);
  }
  ::close(descriptor);
}

/// Once in the life of a program: a folder of many files would be listed for each of them.
bool is_first_visit(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> visited;
  std::error_code failure;
  const fs::path whole = fs::absolute(folder, failure).lexically_normal();
  const std::lock_guard lock(mutex);
  return visited.insert(whole).second;
}

void remove_abandoned_in(const fs::path& folder) {
  if (!is_first_visit(folder)) return;
  std::error_code failure;
  fs::directory_iterator entry(folder, failure);
  while (!failure && entry != fs::directory_iterator()) {
    if (is_temporary_name(entry->path().filename().native())) remove_if_abandoned(entry->path());
    entry.increment(failure);
  }
}

}  // namespace

Temporary::Temporary(Kind kind, const fs::path& place) {
  static std::atomic<unsigned long> next{0};
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  remove_abandoned_in(folder);
  for (;;) {
    path_ = place.parent_path() / fmt::format(".{}{}{}-{}{}",
                                              place.filename().string().substr(0, kLongestStem),
                                              kMark, ::getpid(), next++, kEnd);
    auto unfinished = std::make_unique<Unfinished>(path_);
    if (kind == Kind::kFile) {
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } else if (::mkdir(path_.c_str(), 0777) == 0) {
      descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (descriptor_ < 0 && errno == ENOENT) continue;
    }
    if (descriptor_ < 0) {
      if (errno == EEXIST) continue;
      throw OutputError(place, std::strerror(errno));
    }
    // Before the lock was held, another program may have taken this for abandoned.
    const bool taken = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!taken && has_name(descriptor_, path_)) {
      unfinished_ = std::move(unfinished);
      return;
    }
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

Temporary::~Temporary() {
  if (unfinished_) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ::close(descriptor_);
}

void Temporary::keep() { unfinished_.reset(); }

}  // namespace traverse::files
