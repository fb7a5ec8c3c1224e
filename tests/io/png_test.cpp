#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "base/random.h"
#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

Image random_image(uint32_t width, uint32_t height, uint64_t seed) {
  Random random(seed);
  Image image{width, height, {}};
  for (uint64_t i = 0; i < uint64_t{width} * height * 3; ++i) image.rgb.push_back(static_cast<uint8_t>(random.next()));
  return image;
}

TEST(Png, PixelsComeBack) {
  const test::TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair<uint32_t, uint32_t>{1, 1}, {7, 3}, {3, 200}, {333, 1}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const Image image = random_image(width, height, width);
    save_png(image, folder.file("a.png"));
    const std::string bytes = test::get_file(folder.file("a.png"));
    int w = 0, h = 0, channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                            static_cast<int>(bytes.size()), &w, &h, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(static_cast<uint32_t>(w), width);
    EXPECT_EQ(static_cast<uint32_t>(h), height);
    ASSERT_EQ(channels, 3);
    EXPECT_EQ(std::vector<uint8_t>(pixels, pixels + image.rgb.size()), image.rgb);
    stbi_image_free(pixels);
  }
}

TEST(Png, WrongSizesAreRefused) {
  const test::TemporaryFolder folder;
  const auto code = [&](const Image& image) {
    return test::error_of([&] { save_png(image, folder.file("a.png")); }).code;
  };
  EXPECT_EQ(code({}), ErrorCode::kUsage);
  EXPECT_EQ(code({2, 2, std::vector<uint8_t>(11)}), ErrorCode::kUsage);
  EXPECT_EQ(code({100000, 100000, {}}), ErrorCode::kLimit);
  EXPECT_EQ(code({0xffffffff, 0xffffffff, {}}), ErrorCode::kLimit);
  EXPECT_TRUE(test::file_names(folder.path()).empty());
  EXPECT_EQ(test::error_of([&] { save_png(random_image(50, 50, 1), "/dev/full"); }).code, ErrorCode::kUnwritable);
}

}  // namespace
}  // namespace raygrain
