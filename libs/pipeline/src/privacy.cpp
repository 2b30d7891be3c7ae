#include "traverse/pipeline/privacy.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <pwd.h>
#include <system_error>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "traverse/files/json_document.hpp"
#include "traverse/pipeline/provenance.hpp"

namespace traverse::pipeline {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kWithheld = "not told";
constexpr std::string_view kBeforePath = " \t\n\"'`=([,;:<|";
constexpr std::string_view kAfterPath = " \t\n\"'`)],;:<>|";

/// Folders below the root that a text from another machine may name too.
constexpr std::array<std::string_view, 14> kRootFolders{"data",    "home",  "media",   "mnt", "opt",
                                                        "private", "root",  "scratch", "srv", "tmp",
                                                        "usr",     "Users", "var",     "work"};

fs::path common_folder(const fs::path& a, const fs::path& b) {
  fs::path common;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end() && *i == *j; ++i, ++j) {
    common /= *i;
  }
  return common;
}

bool is_above(const fs::path& folder, const fs::path& path) {
  return folder != path && common_folder(folder, path) == folder;
}

/// Absolute, without links on the way: the last name stays as it is called.
fs::path real_path(const fs::path& path) {
  if (path.empty()) return path;
  fs::path whole = fs::absolute(path).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  std::error_code failure;
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), failure);
  return failure ? whole : folder / whole.filename();
}

fs::path home_folder() {
  const char* home = std::getenv("HOME");
  return home == nullptr || *home == '\0' ? fs::path() : real_path(home);
}

std::string user_name() {
  const passwd* user = ::getpwuid(::getuid());
  return user == nullptr ? std::string() : std::string(user->pw_name);
}

/// A topic or a unit may begin with a slash too.
bool is_path_of_a_machine(std::string_view text) {
  const std::size_t end = text.find('/', 1);
  const std::string_view first = text.substr(1, end == std::string_view::npos ? end : end - 1);
  if (first.empty()) return false;
  if (std::find(kRootFolders.begin(), kRootFolders.end(), first) != kRootFolders.end()) return true;
  std::error_code ignored;
  return fs::exists(fs::path("/") / first, ignored);
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

Privacy::Privacy(const fs::path& place) : place_(real_path(place)), home_(home_folder()) {
  for (std::string name : {user_name(), home_.filename().string(), host_info().name}) {
    if (!name.empty()) names_.push_back(std::move(name));
  }
}

std::string Privacy::path(const fs::path& path) const {
  if (!path.is_absolute()) return path.string();
  const fs::path whole = real_path(path);
  const fs::path common = common_folder(whole, place_);
  const fs::path from_here = whole.lexically_relative(place_);
  const bool tells_a_name = std::any_of(from_here.begin(), from_here.end(), [&](const auto& part) {
    return std::find(names_.begin(), names_.end(), part) != names_.end();
  });
  const bool may_be_told =
      common != common.root_path() && !is_above(common, home_) && !tells_a_name;
  return may_be_told ? from_here.string() : whole.filename().string();
}

std::string Privacy::text(std::string_view text) const {
  std::error_code ignored;
  if (text.starts_with('/') && is_path_of_a_machine(text) && fs::exists(text, ignored)) {
    return path(text);  // a path with blanks, too
  }
  std::string told;
  for (std::size_t i = 0; i < text.size();) {
    const bool may_begin =
        text[i] == '/' && (i == 0 || kBeforePath.find(text[i - 1]) != std::string_view::npos);
    const std::size_t end = std::min(text.find_first_of(kAfterPath, i), text.size());
    if (!may_begin || !is_path_of_a_machine(text.substr(i, end - i))) {
      told += text[i++];
      continue;
    }
    told += path(text.substr(i, end - i));
    i = end;
  }
  if (home_.has_filename()) replace_all(told, home_.string() + "/", "~/");
  return told;
}

std::vector<std::string> Privacy::texts(const std::vector<std::string>& texts) const {
  std::vector<std::string> told;
  for (const std::string& one : texts) told.push_back(text(one));
  return told;
}

std::string Privacy::record(std::string_view json) const {
  static_cast<void>(files::JsonDocument::parse(json));  // bounds its nesting
  OrderedJson record = OrderedJson::parse(json);
  const auto tell = [&](const auto& again, OrderedJson& value) -> void {
    if (value.is_string()) {
      value = text(value.get<std::string>());
    } else if (value.is_array()) {
      for (OrderedJson& one : value) again(again, one);
    } else if (value.is_object()) {
      OrderedJson told = OrderedJson::object();
      for (auto& [key, one] : value.items()) {
        again(again, one);
        told[text(key)] = std::move(one);
      }
      value = std::move(told);
    }
  };
  tell(tell, record);
  for (const char* key : {"name", "cpu"}) record["host"][key] = kWithheld;
  OrderedJson& recording = record["recording"];
  const bool is_told = fs::path(recording.value("path", "")).has_parent_path();
  if (!is_told && recording.contains("path_from_run")) recording["path_from_run"] = nullptr;
  record["private"] = true;
  return record.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace traverse::pipeline
