#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/dataset/recording_survey.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/plausibility/finding.hpp"

/// What is wrong with a recording for each command, and what to do about it.
namespace traverse::plausibility {

enum class Effect {
  kFails,  ///< `run` fails
  kWorse,  ///< a result is worse than it could be
  kNote,   ///< to be known; nothing is worse for it
};

std::string_view name_of(Effect effect);  ///< "fails", "worse", "note"

/// One finding and the one next action.
struct Diagnosis {
  std::string code;  ///< stable, snake_case: of list_diagnoses() or of a check
  Effect effect = Effect::kWorse;
  std::string found;   ///< what was found, with its figure
  std::string means;   ///< for which command: "run, replay: scans are not deskewed"
  std::string action;  ///< what to do next, one step
};

/// "fails  imu_in_g: FOUND; run: MEANS. Next: ACTION"
std::string to_text(const Diagnosis& diagnosis);

/// Of a recording that cannot be opened.
Diagnosis diagnose_unopened(const std::filesystem::path& path, const files::InputError& error);

/// Of one that was read to its end. \param findings those of StreamChecks, weighed for the
/// estimator \param why_no_pipeline what making the estimator said; empty: it was made
/// Those for which `run` fails come first.
std::vector<Diagnosis> diagnose(const dataset::Source& source,
                                const dataset::RecordingSurvey& survey,
                                const std::vector<Finding>& findings,
                                const std::string& why_no_pipeline);

/// Codes that are not those of checks, and what each means.
struct DiagnosisDescription {
  std::string_view code;
  std::string_view means;
};
std::vector<DiagnosisDescription> list_diagnoses();

}  // namespace traverse::plausibility
