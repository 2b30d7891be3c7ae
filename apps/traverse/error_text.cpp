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
    return fmt::format(
        "out of memory: the system gave no more to `{}`. Close other programs, or ask for less at "
        "a time (--first and --last, fewer --threads, coarser settings)",
        command);
  } catch (const std::length_error&) {
    return fmt::format(
        "out of memory: `{}` asked for more than any memory holds, which a damaged input file can "
        "cause. `traverse info` of the recording tells what is in it",
        command);
  } catch (const nlohmann::json::exception& error) {
    return fmt::format(
        "a JSON file that `{}` read is not as this program writes it ({}). Make it again with the "
        "command that wrote it",
        command, without_number(error.what()));
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return fmt::format("`{}` failed without a reason. Please report how this came about", command);
  }
}

}  // namespace traverse::app
