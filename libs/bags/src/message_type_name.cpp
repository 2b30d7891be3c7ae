#include "message_type_name.hpp"

#include <vector>

namespace traverse::bags {

std::string plain_type_name(std::string_view stored) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const bool is_colons = stored[i] == ':' && i + 1 < stored.size() && stored[i + 1] == ':';
    if (stored[i] == '/' || is_colons) {
      parts.emplace_back();
      i += is_colons ? 1 : 0;
    } else {
      parts.back() += stored[i];
    }
  }
  if (parts.size() < 3) return std::string(stored);
  if (parts[2] == "dds_" && parts.back().ends_with('_')) parts.back().pop_back();
  return parts.front() + "/" + parts.back();
}

}  // namespace traverse::bags
