#include "traverse/dataset/source.hpp"

#include <stdexcept>

namespace traverse::dataset {

void Source::return_to(const Bookmark&) {
  throw std::logic_error("this source makes no bookmarks");
}

}  // namespace traverse::dataset
