#include "traverse/mrpt_io/gz_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <zlib.h>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::mrpt_io {

using files::InputError;
using files::OutputError;
using files::Place;

namespace {

constexpr unsigned int kZlibBuffer = 1 << 18;
constexpr std::size_t kKeptBack = 1 << 20;      // damage that shows later than this is not caught
constexpr std::uint64_t kMostGzipRatio = 1032;  // a bit stands for 258 bytes at most, two for each
constexpr const char* kCutShort = "the file is cut short";
constexpr std::size_t kPiece = 1 << 16;
constexpr std::size_t kMostAtOnce = 1 << 30;  // zlib counts in int

void close_quietly(gzFile_s* file) { ::gzclose(file); }

std::string fault_of(gzFile_s* file) {
  int code = Z_OK;
  const char* text = ::gzerror(file, &code);
  return code == Z_ERRNO ? std::strerror(errno) : std::string(text);
}

}  // namespace

GzInput::GzInput(std::filesystem::path path)
    : path_(std::move(path)),
      file_(nullptr, nullptr),
      buffer_(4 * kKeptBack),
      ahead_file_(nullptr, nullptr) {
  errno = 0;
  file_ = {::gzopen(path_.c_str(), "rb"), close_quietly};
  if (!file_) throw InputError(path_, Place::whole_file(), "a readable file", std::strerror(errno));
  ::gzbuffer(file_.get(), kZlibBuffer);
  file_size_ = std::filesystem::file_size(path_);
}

/// Fills the buffer when less than the stretch that is kept back is left in it.
void GzInput::read_ahead() {
  if (at_end_ || end_ - begin_ > kKeptBack) return;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  while (end_ < buffer_.size()) {
    // Piece by piece: with an error, zlib gives nothing of the whole piece.
    const std::size_t piece = std::min(kPiece, buffer_.size() - end_);
    const int got = ::gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned int>(piece));
    at_end_ = got <= 0;
    if (at_end_) break;
    end_ += static_cast<std::size_t>(got);
  }
  int code = Z_OK;
  ::gzerror(file_.get(), &code);
  if (code == Z_BUF_ERROR) {
    fault_ = kCutShort;
  } else if (code != Z_OK) {
    fault_ = "damaged compressed data: " + fault_of(file_.get());
    end_ -= std::min(kKeptBack, end_ - begin_);  // the damage began somewhere in there
  }
}

std::string_view GzInput::ahead() const { return {buffer_.data() + begin_, end_ - begin_}; }

std::string_view GzInput::peek(std::size_t count) {
  read_ahead();
  return ahead().substr(0, count);
}

std::size_t GzInput::Read(void* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    read_ahead();
    const std::size_t kept_back = at_end_ ? 0 : kKeptBack;
    const std::size_t part = std::min(count - done, ahead().size() - kept_back);
    if (part == 0) {
      if (fault_.empty()) fault_ = kCutShort;
      throw std::runtime_error(fault_);
    }
    std::memcpy(static_cast<char*>(to) + done, ahead().data(), part);
    begin_ += part;
    position_ += part;
    done += part;
  }
  if (max_counted_) check_count(to, count);
  return count;
}

void GzInput::check_count(const void* bytes, std::size_t count) {
  std::uint32_t number = 0;
  if (count != sizeof number || std::exchange(things_follow_, false)) {
    things_follow_ = false;
    return;
  }
  std::memcpy(&number, bytes, sizeof number);
  if (number > *max_counted_) throw std::runtime_error("a count that cannot be");
  things_follow_ = number == 1 || number == 2 || number == 4;
}

void GzInput::go_to(std::uint64_t position) {
  ::gzclearerr(file_.get());
  fault_.clear();
  at_end_ = false;
  begin_ = end_ = 0;
  position_ = position;
  if (::gzseek(file_.get(), static_cast<z_off_t>(position), SEEK_SET) < 0) {
    at_end_ = true;
    fault_ = fault_of(file_.get());
  }
}

bool GzInput::reaches(std::uint64_t end) {
  const std::uint64_t buffered = position_ + (end_ - begin_);
  if (end <= std::max(buffered, known_until_)) return true;
  if (at_end_) return false;
  if (::gzdirect(file_.get()) != 0) return end <= file_size_;
  if (end - buffered > kMostGzipRatio * file_size_) return false;
  if (!ahead_file_) ahead_file_ = {::gzopen(path_.c_str(), "rb"), close_quietly};
  if (!ahead_file_) return false;
  std::vector<char> piece(kPiece);
  while (known_until_ < end) {
    const int got = ::gzread(ahead_file_.get(), piece.data(), static_cast<unsigned>(piece.size()));
    if (got <= 0) return false;
    known_until_ += static_cast<std::uint64_t>(got);
  }
  return true;
}

std::size_t GzInput::Write(const void*, std::size_t) {
  throw std::logic_error("a file opened for reading is not written");
}

double GzInput::share_read() const {
  const auto taken = static_cast<double>(::gzoffset(file_.get()));
  return file_size_ == 0 ? 1.0 : std::clamp(taken / static_cast<double>(file_size_), 0.0, 1.0);
}

GzOutput::GzOutput(std::filesystem::path path, int level)
    : path_(std::move(path)), file_(nullptr, nullptr) {
  const std::string mode = level == 0 ? "wbT" : fmt::format("wb{}", level);  // T: no compression
  errno = 0;
  file_ = {::gzopen(path_.c_str(), mode.c_str()), close_quietly};
  if (!file_) throw OutputError(path_, std::strerror(errno));
  ::gzbuffer(file_.get(), kZlibBuffer);
}

std::size_t GzOutput::Write(const void* from, std::size_t count) {
  std::size_t done = 0;
  while (done < count && fault_.empty()) {
    const auto part = static_cast<unsigned int>(std::min(count - done, kMostAtOnce));
    const int taken = ::gzwrite(file_.get(), static_cast<const char*>(from) + done, part);
    if (taken <= 0) fault_ = fault_of(file_.get());
    done += static_cast<std::size_t>(std::max(taken, 0));
  }
  return done;
}

std::size_t GzOutput::Read(void*, std::size_t) {
  throw std::logic_error("a file opened for writing is not read");
}

void GzOutput::close() {
  errno = 0;
  const int result = ::gzclose(file_.release());
  if (fault_.empty() && result != Z_OK) {
    fault_ = result == Z_ERRNO ? std::strerror(errno) : "not every byte was taken";
  }
  if (!fault_.empty()) throw OutputError(path_, fault_);
}

}  // namespace traverse::mrpt_io
