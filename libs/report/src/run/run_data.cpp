#include "run/run_data.hpp"

#include "traverse/pipeline/privacy.hpp"

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
  return run;
}

}  // namespace traverse::report
