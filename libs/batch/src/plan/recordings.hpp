#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/job.hpp"
#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// Makes the plan's generated recordings below OUT/recordings, unless they are there, and gives
/// each its path. They are made again for another world, other arguments or another program.
/// \param program_id what the program is
/// \param making told the name of each before it is made
/// \throws files::InputError with the plan's line if `traverse simulate` fails.
void make_recordings(Plan& plan, const BatchFolder& folder, const std::filesystem::path& program,
                     const std::string& program_id, const std::atomic<bool>& stop,
                     const std::function<void(const std::string& name)>& making);

/// Makes what commands read of the plan's recordings ({format:NAME}) below OUT/recordings, unless
/// it is there: files are named by the recordings' digests. \param converting told "NAME to FORMAT"
/// before each \throws files::InputError with the plan's line if `traverse convert` fails
void convert_recordings(Plan& plan, const BatchFolder& folder, const RecordingDigests& digests,
                        const std::filesystem::path& program, const std::atomic<bool>& stop,
                        const std::function<void(const std::string& name)>& converting);

/// The digest of what each recording of the plan is: every file of its folder, or the file with
/// those that share its name (drive.rawlog, drive.traverse.yaml, drive.reference.tum,
/// drive_Images/), its statements file and its reference.
///
/// Reading terabytes at each start would be dear: a digest is kept in OUT/recordings.json together
/// with the names, sizes and times of change of all these files, and taken from there as long as
/// those are the same.
/// \param reading told the name of each whose content must be read
RecordingDigests digest_recordings(const Plan& plan, const BatchFolder& folder,
                                   const std::function<void(const std::string& name)>& reading);

}  // namespace traverse::batch
