#include <limits>
#include <ostream>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include "raygrain/error.h"
#include "raygrain/io.h"

namespace raygrain {

namespace {

void append_bytes(void* stream, void* bytes, int count) {
  static_cast<std::ostream*>(stream)->write(static_cast<const char*>(bytes), count);
}

}  // namespace

void save_png(const Image& image, const std::string& path) {
  constexpr uint64_t kMaxBytes = std::numeric_limits<int>::max() / 2;  // the encoder counts in int
  const uint64_t row = uint64_t{image.width} * 3;
  if (image.width == 0 || image.height == 0) throw Error(ErrorCode::kUsage, path, "a picture needs at least one pixel");
  if (row > kMaxBytes || (row + 1) * image.height > kMaxBytes)
    throw Error(ErrorCode::kLimit, path,
                "a picture of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels is too large for a PNG",
                "make it smaller");
  if (image.rgb.size() != row * image.height)
    throw Error(ErrorCode::kUsage, path, "the pixels do not fill the picture's width and height");
  write_file_atomically(path, [&](std::ostream& stream) {
    if (!stbi_write_png_to_func(append_bytes, &stream, static_cast<int>(image.width), static_cast<int>(image.height), 3,
                                image.rgb.data(), static_cast<int>(row)))
      stream.setstate(std::ios::failbit);
  });
}

}  // namespace raygrain
