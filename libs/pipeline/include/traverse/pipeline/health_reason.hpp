#pragma once

#include <string>
#include <string_view>

namespace traverse::pipeline {

/// How far a run can be believed. The worse is the greater.
enum class Health {
  kOk,        ///< nothing known speaks against it
  kDegraded,  ///< usable, with what is said of it
  kLost       ///< the path is not one that the vehicle drove
};
std::string_view name_of(Health health);  ///< "ok", "degraded", "lost"

/// Why a run is not ok.
struct HealthReason {
  Health severity = Health::kDegraded;
  std::string code;  ///< "not_registered": for programs, docs/run-folder.md lists them
  std::string text;  ///< a sentence for people, with its figure
};

}  // namespace traverse::pipeline
