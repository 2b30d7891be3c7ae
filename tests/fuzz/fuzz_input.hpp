#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

/// What the fuzz targets share. A target is one file with LLVMFuzzerTestOneInput, which gives the
/// fuzzer's bytes to public readers as a file.
namespace traverse::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder in which the fuzzer's bytes stand as files, one input after the other.
class InputFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

 private:
  testing::TemporaryFolder folder_;
};

/// An InputError is how a reader refuses a file. Any other exception is not caught: a finding.
template <typename Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const files::InputError&) {
  }
}

/// Opens a recording and reads it to its end.
inline void read_recording(const std::filesystem::path& path,
                           dataset::OpenOptions options = {{}, {}, TRAVERSE_SHARE_DIR}) {
  read_or_refuse([&] {
    const auto source = dataset::open_recording(path, options);
    while (source->next()) {
    }
  });
}

}  // namespace traverse::fuzz
