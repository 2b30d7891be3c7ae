#include "traverse/render/image.hpp"

#include <csignal>
#include <filesystem>
#include <sys/resource.h>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::render {
namespace {

using testing::TemporaryFolder;

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int channel : {x * 7, y * 5, x * y}) {
        image.rgb.push_back(static_cast<std::uint8_t>(channel % 256));
      }
    }
  }
  return image;
}

/// A file that grows beyond the limit is cut by the system: as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(Image, IsWrittenAsAPngOfItsSize) {
  const TemporaryFolder folder;
  gradient(300, 200).write_png(folder / "a.png");
  const std::string bytes = files::read_text(folder / "a.png");
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(12, 12), std::string("IHDR\0\0\x01\x2c\0\0\0\xc8", 12));
  EXPECT_EQ(bytes, gradient(300, 200).encode_png());
}

TEST(Image, ItsPngHoldsItsPixels) {
  const Image image = gradient(30, 20);
  const std::string png = image.encode_png();
  const std::vector<char> bytes(png.begin(), png.end());
  const cv::Mat decoded = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ASSERT_EQ(decoded.cols, 30);
  ASSERT_EQ(decoded.rows, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) {
      const auto& pixel = decoded.at<cv::Vec3b>(y, x);  // blue first
      EXPECT_EQ(image.at(x, y), (Colour{pixel[2], pixel[1], pixel[0]}));
    }
  }
}

TEST(Image, KnowsItsPixels) { EXPECT_EQ(gradient(300, 200).at(10, 3), (Colour{70, 15, 30})); }

TEST(Image, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(gradient(3, 2).write_png(folder / "missing/a.png"), files::OutputError);
  {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(gradient(300, 200).write_png(folder / "a.png"), files::OutputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace traverse::render
