#include "json_output.hpp"

#include <fstream>
#include <system_error>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::app {

void write_json_output(const std::filesystem::path& file, const std::string& json) {
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
  files::write_text(file, json);
}

}  // namespace traverse::app
