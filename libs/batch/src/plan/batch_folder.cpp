#include "traverse/batch/batch_folder.hpp"

#include "traverse/files/atomic_file.hpp"

namespace traverse::batch {

void BatchFolder::prepare() const {
  files::make_writable_folder(path);
  for (const auto& folder : {recordings(), runs(), journals()}) {
    files::make_writable_folder(folder);
  }
}

}  // namespace traverse::batch
