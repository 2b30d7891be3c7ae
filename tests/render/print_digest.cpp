/// Prints the digest of the sample drawing, rendered here and in a worker thread: run by a test
/// under several numbers of OpenGL threads, which are fixed when a process begins.
#include <cstdio>
#include <thread>

#include "traverse/files/digest.hpp"
#include "traverse/render/renderer.hpp"

#include "render/sample_drawing.hpp"

int main() {
  const auto print = [] {
    const auto image =
        traverse::render::Renderer().render(traverse::render::sample_drawing(900, 700));
    std::printf("%s\n", traverse::files::sha256_of_text(image.encode_png()).c_str());
  };
  print();
  std::thread(print).join();
  return 0;
}
