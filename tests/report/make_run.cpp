/// make_run FOLDER [FRAMES POINTS]: the folder of a made run.
#include <cstdio>
#include <filesystem>
#include <string>

#include "made_run.hpp"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::fprintf(stderr, "usage: make_run FOLDER [FRAMES POINTS]\n");
    return 2;
  }
  traverse::report::MadeRunOptions options;
  options.map_points = 20'000;
  if (argc == 4) {
    options.frames = std::stoul(argv[2]);
    options.map_points = std::stoul(argv[3]);
  }
  std::filesystem::create_directories(argv[1]);
  traverse::report::make_run(argv[1], options);
  return 0;
}
