#pragma once

#include <filesystem>
#include <string>

namespace traverse::app {

/// Whether the folder is that of a run.
bool is_run_folder(const std::filesystem::path& folder);

/// What a run was made from, how it went, how good it is, and what can be done with it, as text.
/// \throws files::InputError if one of its files is damaged
std::string run_text(const std::filesystem::path& folder);
/// The same as JSON.
std::string run_json(const std::filesystem::path& folder);

}  // namespace traverse::app
