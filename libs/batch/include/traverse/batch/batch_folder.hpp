#pragma once

#include <filesystem>
#include <string>

namespace traverse::batch {

/// The places of a batch's files; docs/batch.md describes them.
struct BatchFolder {
  std::filesystem::path path;

  std::filesystem::path plan() const { return path / "plan.yaml"; }
  std::filesystem::path jobs() const { return path / "jobs.jsonl"; }
  std::filesystem::path digests() const { return path / "recordings.json"; }
  std::filesystem::path recordings() const { return path / "recordings"; }
  std::filesystem::path runs() const { return path / "runs"; }
  std::filesystem::path journals() const { return path / "journal"; }
  std::filesystem::path submissions() const { return path / "slurm"; }
  std::filesystem::path results_csv() const { return path / "results.csv"; }
  std::filesystem::path results_json() const { return path / "results.json"; }
  std::filesystem::path leaderboard_tex() const { return path / "leaderboard.tex"; }
  /// The tables that the plan asks for, as Markdown.
  std::filesystem::path tables() const { return path / "tables.md"; }
  std::filesystem::path report() const { return path / "batch.html"; }

  /// The folder's name of a run: the first 16 digits of its id.
  static std::string run_name(const std::string& id) { return id.substr(0, 16); }
  std::filesystem::path run(const std::string& id) const { return runs() / run_name(id); }
  std::filesystem::path completion(const std::string& id) const { return run(id) / "result.json"; }

  /// Makes the folders. \throws files::OutputError
  void prepare() const;
};

}  // namespace traverse::batch
