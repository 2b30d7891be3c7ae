#pragma once

#include <string>
#include <utility>

#include "traverse/config/document.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::batch {

/// An error at a place of the plan, to be thrown.
inline files::InputError plan_error(const config::Origin& origin, std::string expected,
                                    std::string found) {
  return {origin.source, files::Place::line(origin.line), std::move(expected), std::move(found)};
}

}  // namespace traverse::batch
