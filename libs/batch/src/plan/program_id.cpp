#include "plan/program_id.hpp"

#include <fmt/format.h>

#include "traverse/files/digest.hpp"
#include "traverse/pipeline/provenance.hpp"

namespace traverse::batch {

std::string program_id(const std::filesystem::path& program,
                       const std::filesystem::path& share_folder) {
  const pipeline::BuildInfo build = pipeline::build_info();
  std::string id = fmt::format("traverse {} {} {}", build.version, build.commit, build.build_type);
  if (build.commit.find("dirty") == std::string::npos && build.commit != "unknown") return id;
  return id + fmt::format(" {} {} {}", files::sha256_of_file(program),
                          files::content_id(share_folder / "pipelines").sha256,
                          files::content_id(share_folder / "sensors").sha256);
}

}  // namespace traverse::batch
