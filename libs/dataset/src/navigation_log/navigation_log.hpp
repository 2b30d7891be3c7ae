#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// Whether the first line with data begins with IMU, ODOM or GNSS.
bool is_navigation_log(const std::filesystem::path& file);

/// Opens a text log of navigation sensors:
///     IMU  t gx gy gz ax ay az                  rad/s (or deg/s as stated) and m/s^2
///     ODOM t left right                         encoder pulses, in the interval or cumulative
///     GNSS t lat lon alt heading heading_valid  degrees and metres; heading clockwise from north
/// '#' begins a comment. A line that is none of these is skipped and counted with its number.
/// \param format the name of it, see recording_formats.hpp
/// \throws files::InputError if no line can be used.
std::unique_ptr<Source> open_navigation_log(const std::filesystem::path& file,
                                            const OpenOptions& options, std::string_view format);

/// Opens a folder of CSV files as the statements under `csv` say.
/// \throws files::InputError if a file, a column or the statement is missing.
std::unique_ptr<Source> open_csv_folder(const std::filesystem::path& folder,
                                        const OpenOptions& options, std::string_view format);

}  // namespace traverse::dataset
