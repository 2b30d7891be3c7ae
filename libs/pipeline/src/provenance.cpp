#include "traverse/pipeline/provenance.hpp"

#include <chrono>
#include <fstream>
#include <string_view>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace traverse::pipeline {

namespace {

/// What stands behind `key` and `separator` on the first such line of a system file.
std::string look_up(const char* file, std::string_view key, char separator) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(key)) continue;
    std::string value = line.substr(line.find(separator) + 1);
    while (!value.empty() && (value.front() == ' ' || value.front() == '"')) value.erase(0, 1);
    while (!value.empty() && value.back() == '"') value.pop_back();
    return value;
  }
  return "unknown";
}

}  // namespace

HostInfo host_info() {
  utsname kernel{};
  ::uname(&kernel);
  HostInfo host;
  host.name = kernel.nodename;
  host.system = fmt::format("{}, {} {}", look_up("/etc/os-release", "PRETTY_NAME", '='),
                            kernel.sysname, kernel.release);
  host.cpu = look_up("/proc/cpuinfo", "model name", ':');
  host.logical_cpus = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  host.memory_gb = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                   static_cast<double>(::sysconf(_SC_PAGE_SIZE)) * 1e-9;
  return host;
}

double peak_memory_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string utc_now() {
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace traverse::pipeline
