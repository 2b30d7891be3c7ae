#pragma once

#include <filesystem>
#include <string>

namespace traverse::app {

/// Writes what `--json FILE` asks for. An earlier file of figures is replaced; one that holds
/// anything else, a trajectory that was named by mistake say, is not.
/// \throws files::OutputError
void write_json_output(const std::filesystem::path& file, const std::string& json);

}  // namespace traverse::app
