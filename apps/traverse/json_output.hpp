#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace traverse::app {

/// Writes what `--json FILE` asks for. An earlier file of figures is replaced; one that holds
/// anything else, a trajectory that was named by mistake say, is not.
/// \throws files::OutputError
void write_json_output(const std::filesystem::path& file, const std::string& json);

/// The same of a document that is too large to be held as text. \param write puts it into the
/// stream
void write_json_output(const std::filesystem::path& file,
                       const std::function<void(std::ostream&)>& write);

}  // namespace traverse::app
