#pragma once

#include <string>
#include <utility>
#include <vector>

namespace traverse::pipeline {

/// The program that made a result.
struct BuildInfo {
  std::string version;     ///< "0.2.0"
  std::string commit;      ///< "1a2b3c4", with "-dirty" when the sources were changed; or "unknown"
  std::string build_type;  ///< "Release"
  std::string compiler;    ///< "GNU 12.2.0"
  std::vector<std::pair<std::string, std::string>> libraries;  ///< name, version
};
BuildInfo build_info();

/// The machine it was made on.
struct HostInfo {
  std::string name;
  std::string system;  ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
  std::string cpu;
  int logical_cpus = 0;
  double memory_gb = 0;
};
HostInfo host_info();

/// The largest resident memory of this process so far, megabytes.
double peak_memory_mb();

/// The present time as "2026-11-22T10:15:30Z".
std::string utc_now();

}  // namespace traverse::pipeline
