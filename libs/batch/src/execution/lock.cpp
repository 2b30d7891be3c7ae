#include "execution/lock.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "execution/host_name.hpp"

namespace traverse::batch {

BatchLock::BatchLock(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw files::OutputError(file, std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    ::close(descriptor_);
    if (error != EWOULDBLOCK) throw files::OutputError(file, std::strerror(error));
    throw std::runtime_error(fmt::format("{}: another batch is at work here: {}",
                                         file.parent_path().string(), files::read_text(file)));
  }
  const std::string owner =
      fmt::format("process {} on {} since {}", ::getpid(), host_name(), pipeline::utc_now());
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::write(descriptor_, owner.data(), owner.size()) != static_cast<ssize_t>(owner.size())) {
    const int error = errno;
    ::close(descriptor_);
    throw files::OutputError(file, std::strerror(error));
  }
}

BatchLock::~BatchLock() { ::close(descriptor_); }

bool BatchLock::is_held(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

}  // namespace traverse::batch
