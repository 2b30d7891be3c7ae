#pragma once

#include <filesystem>

#include "run/model.hpp"

namespace traverse::report {

/// Every table of the report as TABLE.csv (RFC 4180, all digits) and TABLE.tex (booktabs, as the
/// page shows numbers). \throws files::OutputError
void export_tables(const Json& tables, const std::filesystem::path& folder);

std::string to_csv(const Json& table);
std::string to_latex(const Json& table);

}  // namespace traverse::report
