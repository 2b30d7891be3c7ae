#include "traverse/files/unfinished.hpp"

#include <mutex>
#include <set>
#include <system_error>

namespace traverse::files {

namespace {

struct UnfinishedList {
  std::mutex mutex;
  std::multiset<std::filesystem::path> paths;
};

/// Never destroyed: a thread may still write while the program ends.
UnfinishedList& unfinished_list() {
  static auto& list = *new UnfinishedList;
  return list;
}

void remove_whole(const std::filesystem::path& path) {
  constexpr int kRounds = 1000;  // another thread may put files into a folder while it is emptied
  std::error_code failure;
  for (int round = 0; round < kRounds; ++round) {
    std::filesystem::remove_all(path, failure);
    if (!failure || failure == std::errc::permission_denied) return;
  }
}

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path) : path_(std::filesystem::absolute(path)) {
  UnfinishedList& list = unfinished_list();
  const std::lock_guard lock(list.mutex);
  list.paths.insert(path_);
}

Unfinished::~Unfinished() {
  UnfinishedList& list = unfinished_list();
  const std::lock_guard lock(list.mutex);
  list.paths.erase(list.paths.find(path_));
}

void remove_unfinished() {
  UnfinishedList& list = unfinished_list();
  list.mutex.lock();  // for good
  for (const std::filesystem::path& path : list.paths) remove_whole(path);
}

}  // namespace traverse::files
