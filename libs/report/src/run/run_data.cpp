#include "run/run_data.hpp"

namespace traverse::report {

RunData read_run(const std::filesystem::path& folder, pipeline::RunPart part) {
  RunData run;
  static_cast<pipeline::RunContents&>(run) = pipeline::read_run({folder}, part);
  run.record = nlohmann::json::parse(run.record_json);
  return run;
}

}  // namespace traverse::report
