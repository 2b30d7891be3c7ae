// Of sanitizer builds alone. Debian's nanogui was compiled before C++17: its widgets are freed by
// Eigen's aligned free, while a C++20 program, for which Eigen leaves that to the compiler, makes
// the same classes by operator new. Both are malloc here; the check of pairs is of no use.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "alloc_dealloc_mismatch=0"; }

// Libraries stay loaded, so that a leak in one of them still has its name when leaks are looked
// for.
extern "C" int dlclose(void* /*library*/) { return 0; }
