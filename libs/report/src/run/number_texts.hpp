#pragma once

#include "traverse/files/number_text.hpp"

/// Numbers in words, as every part of the report writes them.
namespace traverse::report {

using files::bytes_text;
using files::count_text;
using files::duration_text;
using files::full_number;
using files::noun;
using files::plural;
using files::short_number;

}  // namespace traverse::report
