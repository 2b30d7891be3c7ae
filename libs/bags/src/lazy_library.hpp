#pragma once

#include <stdexcept>
#include <string>

namespace traverse::bags {

/// A library that is not there, or without a function that it should have.
class NoLibrary : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A shared library that is loaded when it is first used, so that a program that meets no recording
/// in need of it starts without. It stays loaded.
class LazyLibrary {
 public:
  /// \param name "liblz4.so.1" \param package of Debian that has it. \throws NoLibrary
  LazyLibrary(const char* name, const char* package);

  /// The function `name`. \tparam Function pointer to it, as its header declares it.
  /// \throws NoLibrary
  template <typename Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  std::string name_;
  void* handle_;
};

}  // namespace traverse::bags

/// The function `name` of `library` with the type that its header gives it.
#define TRAVERSE_LAZY_FUNCTION(library, name) (library).function<decltype(&::name)>(#name)
