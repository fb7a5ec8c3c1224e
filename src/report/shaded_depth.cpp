#include <algorithm>
#include <cmath>

#include "raygrain/rays.h"
#include "raygrain/report.h"

#include "base/parallel.h"
#include "report/canvas.h"
#include "report/depth_cue.h"

namespace raygrain {

namespace {

constexpr uint32_t kSamples = 2;  // per pixel and axis
constexpr Colour kBackground{18, 26, 48}, kNear{255, 250, 240}, kFar{150, 164, 190}, kShadow{14, 16, 26};

/// What the picture knows of one sample.
struct Sample {
  float distance = kInf;  // from the near face along the ray's unit direction; infinite for a miss
  float brightness = 0;   // in [0, 1]
};

Vec3d surface_normal(const TriangleMesh& mesh, uint32_t triangle) {
  const Vec3d a = to_double(mesh.vertex(triangle, 0)), b = to_double(mesh.vertex(triangle, 1)),
              c = to_double(mesh.vertex(triangle, 2));
  return cross(b - a, c - a);
}

/// Half light from the eye, half from above the eye's left shoulder, so that faces of one building differ.
float brightness(Vec3d normal, Vec3d direction, const Frame& frame) {
  const double size = length(normal) * length(direction);
  if (!(size > 0)) return 0.5f;
  const double facing = -dot(normal, direction) / size;
  if (facing < 0) normal = -normal;
  const Vec3d lamp = normalized(frame.up * 0.65 + frame.right * 0.45 - frame.forward);
  const double lit = std::max(0.0, dot(normal, lamp) / length(normal));
  return static_cast<float>(0.12 + 0.38 * std::abs(facing) + 0.5 * lit);
}

std::vector<Sample> take_samples(const TriangleMesh& mesh, const Bvh& bvh, const InfluenceArea& area, uint32_t width,
                                 uint32_t height, unsigned threads) {
  const std::vector<Ray> rays = window_grid_rays(area, width, height);
  const Frame frame = AreaGeometry(area).frame();
  std::vector<Sample> samples(rays.size());
  parallel_for(height, 8, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin * width; i < end * width; ++i) {
      const Hit hit = intersect(bvh, mesh, rays[i]);
      if (!is_hit(hit)) continue;
      const Vec3d direction = to_double(rays[i].direction);
      samples[i] = {static_cast<float>(hit.t * length(direction)),
                    brightness(surface_normal(mesh, hit.triangle), direction, frame)};
    }
  });
  return samples;
}

/// Grey by brightness, yellowish near and bluish far, dark behind edges.
Colour sample_colour(const Sample& sample, float cue, float behind) {
  if (sample.distance == kInf) return mixed(kBackground, kShadow, behind * 0.5);
  const Colour lit = mixed(kNear, kFar, cue);
  const double light =
      sample.brightness * (1 - 0.35 * static_cast<double>(cue)) * (1 - 0.6 * static_cast<double>(behind));
  return mixed(kShadow, lit, light);
}

Colour mean_colour(std::span<const Colour> colours) {
  uint32_t red = 0, green = 0, blue = 0;
  for (const Colour c : colours) {
    red += c.red;
    green += c.green;
    blue += c.blue;
  }
  const uint32_t n = static_cast<uint32_t>(colours.size());
  return {static_cast<uint8_t>((red + n / 2) / n), static_cast<uint8_t>((green + n / 2) / n),
          static_cast<uint8_t>((blue + n / 2) / n)};
}

}  // namespace

PictureSize picture_size(const InfluenceArea& area, uint32_t longest) {
  const Vec2d half = AreaGeometry(area).window_half();
  const double scale = longest / std::max(half.x, half.y);
  const auto side = [&](double extent) {
    return static_cast<uint32_t>(std::clamp(std::round(extent * scale), 16.0, std::max(16.0, double{1} * longest)));
  };
  return {side(half.x), side(half.y)};
}

Image shaded_depth(const TriangleMesh& mesh, const Bvh& bvh, const InfluenceArea& area, uint32_t width, uint32_t height,
                   unsigned threads) {
  const uint32_t columns = width * kSamples, rows = height * kSamples;
  const std::vector<Sample> samples = take_samples(mesh, bvh, area, columns, rows, threads);
  std::vector<float> distances(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) distances[i] = samples[i].distance;
  const DepthCues cues = depth_cues(distances, columns, rows);

  Image image = blank_image(width, height, kBackground);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      Colour colours[kSamples * kSamples];
      for (uint32_t k = 0; k < kSamples * kSamples; ++k) {
        const size_t i = (size_t{y} * kSamples + k / kSamples) * columns + size_t{x} * kSamples + k % kSamples;
        colours[k] = sample_colour(samples[i], cues.far_share[i], cues.behind[i]);
      }
      set_pixel(image, x, y, mean_colour(colours));
    }
  }
  return image;
}

}  // namespace raygrain
