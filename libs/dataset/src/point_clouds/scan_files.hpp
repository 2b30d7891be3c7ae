#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"

#include "recording/stamp_files.hpp"
#include "recording/stamp_sequence.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// One scan of a folder, or another record with a file of its own.
struct ScanFile {
  std::filesystem::path file;
  std::optional<geometry::Stamp> stamp;      ///< nothing: it cannot be used
  const char* fault = StampSequence::kNone;  ///< why, where there is none
};

/// "scan9" before "scan10": digits compare as numbers.
bool naturally_before(std::string_view a, std::string_view b);

/// The regular files of `folder` with that extension (".bin", any case), in natural order; none if
/// there is no such folder.
std::vector<std::filesystem::path> files_with_extension(const std::filesystem::path& folder,
                                                        std::string_view extension);

/// The stamps of a file with one a line, settled alone.
std::vector<RecordStamp> settled_stamps(const StampFile& times, const std::string& what,
                                        std::vector<Fact>& facts);
/// The same to be settled with those of other sensors.
SensorStamps sensor_stamps(const StampFile& times, const std::string& what);

/// Gives each scan its stamp from the lines of a times file: the line of its number when every
/// file is named by a number and there is a line for each ("000012.bin" is line 13, also when
/// others are missing), else the line of its position. Says in `facts` which, and when there are
/// more lines than files or files without a line. `what` the files are: "scan".
std::vector<ScanFile> stamp_by_line(const std::vector<std::filesystem::path>& files,
                                    const std::vector<RecordStamp>& stamps,
                                    const std::string& times_name, const std::string& what,
                                    std::vector<Fact>& facts);

/// Gives the scans stamps at equal distances. \throws files::InputError if first_stamp is no time.
std::vector<ScanFile> stamp_by_period(const std::vector<std::filesystem::path>& scans,
                                      const Statements& statements, std::vector<Fact>& facts);

std::vector<std::optional<geometry::Stamp>> stamps_of(const std::vector<ScanFile>& scans);
std::vector<std::optional<geometry::Stamp>> stamps_of(const std::vector<RecordStamp>& records);

}  // namespace traverse::dataset
