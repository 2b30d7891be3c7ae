#include "error_text.hpp"

#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace traverse::app {

namespace {

/// "[json.exception.type_error.302] type must be number" without what only programmers read.
std::string_view without_number(std::string_view text) {
  const std::size_t end = text.find("] ");
  return text.starts_with("[json.") && end != std::string_view::npos ? text.substr(end + 2) : text;
}

}  // namespace

std::string error_text(const std::string& command) {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return command +
           ": out of memory: the system gave no more while the command was at work. Close other "
           "programs, or ask for less at a time (--first and --last, fewer --threads, coarser "
           "settings)";
  } catch (const std::length_error&) {
    return command +
           ": out of memory: more was asked for than any memory holds, which a damaged input file "
           "can cause. `traverse info` of the recording tells what is in it";
  } catch (const nlohmann::json::exception& error) {
    return fmt::format(
        "{}: a JSON file is not as this program writes it ({}). Make it again with the command "
        "that wrote it",
        command, without_number(error.what()));
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return command + ": failed without a reason. Please report how this came about";
  }
}

}  // namespace traverse::app
