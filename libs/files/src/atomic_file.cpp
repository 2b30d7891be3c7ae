#include "traverse/files/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <utility>

#include "traverse/files/input_error.hpp"

#include "temporary.hpp"

namespace traverse::files {

namespace {

namespace fs = std::filesystem;

std::string system_reason(int error, std::string_view otherwise) {
  return error == 0 ? std::string(otherwise) : std::string(std::strerror(error));
}

/// "out/" names the same folder as "out", and a link the folder that it leads to.
fs::path folder_itself(fs::path path) {
  if (!path.has_filename()) path = path.parent_path();
  std::error_code failure;
  if (!fs::is_symlink(path, failure)) return path;
  const fs::path folder = fs::canonical(path, failure);
  return failure ? path : folder;
}

/// The file that a link leads to.
fs::path file_itself(fs::path path) {
  std::error_code failure;
  if (!fs::is_symlink(path, failure)) return path;
  const fs::path file = fs::weakly_canonical(path, failure);
  return failure ? path : file;
}

/// Devices and pipes: there, but neither a file nor a folder.
bool is_special(const fs::path& path) {
  std::error_code failure;
  return fs::is_other(path, failure);
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  errno = 0;
  if (is_special(path_)) {
    stream_.open(path_, std::ios::binary);
  } else {
    path_ = file_itself(std::move(path_));
    temporary_ = std::make_unique<Temporary>(Temporary::Kind::kFile, path_);
    stream_.open(temporary_->path(), std::ios::binary | std::ios::trunc);
  }
  if (!stream_) throw OutputError(path_, system_reason(errno, "the file cannot be opened"));
}

AtomicFile::~AtomicFile() = default;

const fs::path& AtomicFile::temporary_path() const {
  return temporary_ ? temporary_->path() : path_;
}

void AtomicFile::finish() {
  if (!stream_.is_open()) return;
  errno = 0;
  stream_.flush();
  const bool flushed = stream_.good();
  const int error = errno;
  stream_.close();
  if (!flushed || stream_.fail()) {
    throw OutputError(path_, system_reason(error, "not every byte was taken (is the disk full?)"));
  }
}

void AtomicFile::commit() {
  finish();
  if (!temporary_) return;
  std::error_code failure;
  fs::rename(temporary_->path(), path_, failure);
  if (failure) throw OutputError(path_, failure.message());
  temporary_->keep();
}

AtomicFile& AtomicFiles::add(const fs::path& path) {
  return *files_.emplace_back(std::make_unique<AtomicFile>(path));
}

void AtomicFiles::write(const fs::path& path, std::string_view text) {
  AtomicFile& file = add(path);
  file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  file.finish();
}

void AtomicFiles::commit() {
  for (const auto& file : files_) file->finish();
  for (const auto& file : files_) file->commit();
}

AtomicFolder::AtomicFolder(fs::path path, std::vector<std::string> earlier)
    : path_(folder_itself(std::move(path))), earlier_(std::move(earlier)) {
  std::error_code failure;
  const bool is_folder = fs::is_directory(path_, failure);
  if (fs::exists(path_, failure) &&
      !(is_folder && (!earlier_.empty() || fs::is_empty(path_, failure)))) {
    throw OutputError(path_, "it is there already");
  }
  temporary_ = std::make_unique<Temporary>(Temporary::Kind::kFolder, path_);
}

AtomicFolder::~AtomicFolder() = default;

const fs::path& AtomicFolder::temporary_path() const { return temporary_->path(); }

void AtomicFolder::commit() {
  const fs::path& made = temporary_->path();
  std::error_code failure;
  fs::rename(made, path_, failure);  // also over an empty folder
  if (!failure) {
    temporary_->keep();
    return;
  }
  if (earlier_.empty()) throw OutputError(path_, failure.message());
  if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0) {
    temporary_->keep();
    remove_earlier(made);
    return;
  }
  // A file system that cannot exchange: for a moment the earlier result has another name.
  const fs::path aside = made.string() + ".earlier";
  fs::rename(path_, aside, failure);
  if (!failure) fs::rename(made, path_, failure);
  if (failure) {
    std::error_code ignored;
    if (!fs::exists(path_, ignored)) fs::rename(aside, path_, ignored);
    throw OutputError(path_, failure.message());
  }
  temporary_->keep();
  remove_earlier(aside);
}

void AtomicFolder::remove_earlier(const fs::path& replaced) const {
  std::error_code failure;
  for (const std::string& name : earlier_) fs::remove_all(replaced / name, failure);
  for (const auto& entry : fs::directory_iterator(replaced, failure)) {
    fs::path kept = path_ / entry.path().filename();
    while (fs::exists(fs::symlink_status(kept, failure))) kept += ".earlier";
    fs::rename(entry.path(), kept, failure);
  }
  fs::remove(replaced, failure);
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  file.commit();
}

void make_writable_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw OutputError(folder, failure.message());
  if (!std::filesystem::is_directory(folder)) throw OutputError(folder, "it is not a folder");
  AtomicFile probe(folder / "probe");  // removed again: it is never committed
}

}  // namespace traverse::files
