#include "json_output.hpp"

#include <fstream>
#include <ostream>
#include <system_error>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::app {

void write_json_output(const std::filesystem::path& file, const std::string& json) {
  write_json_output(file, [&](std::ostream& stream) { stream << json; });
}

void write_json_output(const std::filesystem::path& file,
                       const std::function<void(std::ostream&)>& write) {
  std::error_code failure;
  if (std::filesystem::is_regular_file(file, failure)) {
    std::ifstream stream(file, std::ios::binary);
    char first = '{';
    stream >> first;
    if (first != '{') {
      throw files::OutputError(
          file, "it is there already and is no JSON file of figures. Choose another name");
    }
  }
  files::AtomicFile output(file);
  write(output.stream());
  output.commit();
}

}  // namespace traverse::app
