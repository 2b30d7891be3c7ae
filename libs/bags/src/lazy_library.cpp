#include "lazy_library.hpp"

#include <dlfcn.h>

#include <fmt/format.h>

namespace traverse::bags {

LazyLibrary::LazyLibrary(const char* name, const char* package)
    : name_(name), handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    throw NoLibrary(
        fmt::format("{} of the package {} cannot be loaded: {}", name, package, ::dlerror()));
  }
}

void* LazyLibrary::symbol(const char* name) const {
  void* found = ::dlsym(handle_, name);
  if (found == nullptr) throw NoLibrary(fmt::format("{} has no function {}", name_, name));
  return found;
}

}  // namespace traverse::bags
