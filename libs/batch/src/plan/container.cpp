#include "plan/container.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/shell_word.hpp"

#include "plan/plan_error.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;

std::optional<fs::path> runtime_named(const char* name) {
  const char* path = std::getenv("PATH");
  if (path == nullptr) return std::nullopt;
  for (const auto folder : files::split_cells(path, ':')) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

/// The runtime's answer to a command, or nothing if it ended with an error.
std::optional<std::string> answer_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) return std::nullopt;
  std::string text;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), static_cast<int>(part.size()), pipe.get()) != nullptr) {
    text += part.data();
  }
  // The exit status comes with the end of the pipe alone; an image without a digest says nothing.
  return files::split_words(text).size() >= 2 ? std::optional(text) : std::nullopt;
}

PlannedContainer of_file(const fs::path& file, const std::string& image,
                         const config::Origin& origin) {
  std::optional<fs::path> runtime = runtime_named("apptainer");
  if (!runtime) runtime = runtime_named("singularity");
  if (!runtime) {
    throw plan_error(origin,
                     "apptainer in the PATH, which runs container images that are files (without "
                     "it, leave 'container' out and install the program here)",
                     fmt::format("none, for {}", files::in_quotes(image)));
  }
  return {image, files::sha256_of_file(file), *runtime, file.string(), true};
}

PlannedContainer of_podman(const std::string& image, const config::Origin& origin) {
  const std::optional<fs::path> runtime = runtime_named("podman");
  if (!runtime) {
    throw plan_error(origin,
                     "podman in the PATH, which runs container images by name, or an image's file "
                     "beside the plan and apptainer (without them, leave 'container' out and "
                     "install the program here)",
                     fmt::format("none, for {}", files::in_quotes(image)));
  }
  const auto told = answer_of(
      fmt::format("{} image inspect --format '{{{{.Id}}}} {{{{.Digest}}}}' {} 2>/dev/null",
                  files::in_shell_quotes(runtime->string()), files::in_shell_quotes(image)));
  if (!told) {
    throw plan_error(origin, fmt::format("an image that podman has here (podman pull {})", image),
                     files::in_quotes(image));
  }
  const auto words = files::split_words(*told);
  return {image, std::string(words[1]), *runtime, std::string(words[0]), false};
}

/// The folders that hold them, each once, none below another.
std::vector<std::string> folders_of(const std::vector<fs::path>& readable) {
  std::vector<std::string> folders;
  for (const fs::path& path : readable) {
    if (path.empty()) continue;
    const fs::path folder = path.lexically_normal().parent_path();
    folders.push_back(folder.string());
  }
  std::sort(folders.begin(), folders.end());
  std::vector<std::string> kept;
  for (const std::string& folder : folders) {
    const bool is_below = std::any_of(kept.begin(), kept.end(), [&](const std::string& other) {
      return folder == other || folder.starts_with(other + "/");
    });
    if (!is_below) kept.push_back(folder);
  }
  return kept;
}

}  // namespace

PlannedContainer find_container(const std::string& image, const fs::path& folder,
                                const config::Origin& origin) {
  const fs::path file = (folder / image).lexically_normal();
  return fs::is_regular_file(file) ? of_file(file, image, origin) : of_podman(image, origin);
}

std::string in_container(const PlannedContainer& container, const std::string& command,
                         const std::vector<fs::path>& readable) {
  std::string text = files::in_shell_quotes(container.runtime.string());
  text += container.is_file ? " exec" : " run --rm --pull=never";
  for (const std::string& folder : folders_of(readable)) {
    text += fmt::format(" {} {}", container.is_file ? "--bind" : "--volume",
                        files::in_shell_quotes(fmt::format("{0}:{0}:ro", folder)));
  }
  // The working folder, under its own name too, to write into; by the variables what it starts is
  // found again, and counted.
  text +=
      container.is_file
          ? R"( --bind "$PWD:$PWD" --pwd "$PWD")"
          : R"( --volume "$PWD:$PWD" --workdir "$PWD" --env TRAVERSE_BATCH_WORK --env OMP_NUM_THREADS)";
  return text + fmt::format(" {} /bin/sh -c {}", files::in_shell_quotes(container.run_as),
                            files::in_shell_quotes(command));
}

}  // namespace traverse::batch
