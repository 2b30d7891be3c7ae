#include "run/run_data.hpp"

#include "traverse/pipeline/privacy.hpp"
#include "traverse/pipeline/run_digests.hpp"

namespace traverse::report {

void make_private(RunData& run, const std::filesystem::path& place) {
  run.record = nlohmann::json::parse(pipeline::Privacy(place).record(run.record_json));
  const std::filesystem::path plain = std::filesystem::absolute(place).lexically_normal();
  run.folder = {plain.has_filename() ? plain.filename() : plain.parent_path().filename()};
}

RunData read_run(const std::filesystem::path& folder, pipeline::RunPart part) {
  RunData run;
  static_cast<pipeline::RunContents&>(run) = pipeline::read_run({folder}, part);
  run.record = nlohmann::json::parse(run.record_json);
  const std::filesystem::path checkpoints = folder / evaluation::kCheckpointsFile;
  if (std::filesystem::is_regular_file(checkpoints)) {
    pipeline::require_as_written({folder}, {checkpoints});
    run.checkpoints = evaluation::read_checkpoint_evaluation(checkpoints);
  }
  return run;
}

}  // namespace traverse::report
