#include <algorithm>
#include <vector>

#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_contents.hpp"

#include "fuzz/fuzz_input.hpp"
#include "report/made_run.hpp"

using namespace traverse;

namespace {

/// A whole run of five frames, one file of which is the fuzzer's.
class Run {
 public:
  Run() {
    report::MadeRunOptions options;
    options.frames = 5;
    options.name = "made";
    report::make_run(input_.path(), options);
    const pipeline::RunFolder files{input_.path()};
    std::filesystem::copy_file(files.trajectory(), files.odometry());
    std::filesystem::copy_file(files.evaluation(), files.odometry_evaluation());
    for (const auto& file : files.files()) {
      names_.push_back(file.filename().string());
      whole_.push_back(std::filesystem::exists(file) ? files::read_text(file) : "");
    }
  }

  void read_with(std::string_view name, std::string_view bytes) const {
    const auto place = std::find(names_.begin(), names_.end(), name);
    if (place == names_.end()) return;
    const auto file = input_.write(*place, bytes);
    fuzz::read_or_refuse([&] { pipeline::read_run({input_.path()}, pipeline::RunPart::kAll); });
    const std::string& whole = whole_[static_cast<std::size_t>(place - names_.begin())];
    if (whole.empty()) {
      std::filesystem::remove(file);
    } else {
      input_.write(*place, whole);
    }
  }

 private:
  fuzz::InputFolder input_;
  std::vector<std::string> names_;
  std::vector<std::string> whole_;  ///< empty: the run has no such file
};

}  // namespace

/// The input: the name of the file on a line of its own, then what is in it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Run run;
  const std::string_view input = fuzz::text_of(data, size);
  const std::size_t line = input.find('\n');
  if (line != std::string_view::npos) run.read_with(input.substr(0, line), input.substr(line + 1));
  return 0;
}
