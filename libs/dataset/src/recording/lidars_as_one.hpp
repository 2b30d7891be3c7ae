#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// The fact by which a source says that lidars are stated to be used as one: their labels, commas
/// between.
inline constexpr const char* kLidarsAsOne = "lidars";
/// The fact by which it says how late the stamps of all but the first are stated to be, seconds,
/// commas between.
inline constexpr const char* kLidarsLate = "lidars_late_s";

/// The labels of such a list.
std::vector<std::string> labels_of_lidars(const std::string& list);

/// "lidars=front,rear" and the like with the list as one text, which YAML takes for two keys; any
/// other statement as it is.
std::string with_list_as_text(const std::string& statement);

/// The source as it is, or, where its facts state several lidars, one whose scans hold the returns
/// of all of them.
///
/// Scans are those of the first that is stated, which each take what the others measured between
/// its beginning and that of the next, moved into its frame by the mountings: a return of a rigid
/// vehicle is where it is whoever saw it, and keeps its own time, by which whoever uses the scan
/// deskews all alike. Rings of the second follow on those of the first. While the first is silent
/// the others go on in sweeps of its length. Returns that are none, or nearer or farther than their
/// own lidar's limits, are left out of scans that are put together.
///
/// Stamps of the others are taken to be late by what is stated, or else by what the first sweeps
/// tell (lidar_clock.hpp), for which it reads the beginning once more; a fact says by how much.
/// \throws files::InputError for a label that is no lidar's, or for seconds that are none
std::unique_ptr<Source> with_lidars_as_one(std::unique_ptr<Source> source);

}  // namespace traverse::dataset
