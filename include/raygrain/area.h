// Influence areas: the parts of a scene whose rays share a direction (plane) or a point (point), and how large boxes
// look to those rays. After section 4 and 5 of "Ray Distribution Aware Heuristics for Bounding Volume Hierarchies
// Construction in Ray Tracing" (2024); hull table after Schmalstieg and Tobler, "Fast projected area computation for
// three-dimensional bounding boxes" (1999).
#pragma once

#include <array>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "raygrain/bounds.h"
#include "raygrain/frame.h"
#include "raygrain/ray.h"
#include "raygrain/region.h"

namespace raygrain {

/// Parallel rays from a rectangle. `center` is the middle of the face where rays start; the region is the box of
/// 2 half_width x 2 half_height x depth along `direction` (any length but zero).
struct PlaneArea {
  Vec3 center, direction{0, 0, 1}, up{0, 1, 0};
  float half_width = 1, half_height = 1, depth = 1;
};

/// Rays through a point, inside a frustum. Fields of view are full angles in degrees, each in (0, 180).
struct PointArea {
  Vec3 eye, forward{0, 0, 1}, up{0, 1, 0};
  float fov_x = 90, fov_y = 90, near_z = 0.1f, far_z = 100;
};

/// `tolerance` = 1 - |cos| of the angle up to which a direction counts as the area's own (0: up to the rounding of a
/// float direction).
struct InfluenceArea {
  std::string name;
  std::variant<PlaneArea, PointArea> shape;
  float tolerance = 0.01f;
};

/// Throws Error (kBadArea, naming `where` and the field) unless all numbers are finite, sizes are positive, directions
/// are not zero, 0 < near_z < far_z, 0 < fov < 180, and 0 <= tolerance < 1. A zero `up` is allowed: see make_frame.
void validate(const InfluenceArea& area, const std::string& where);

struct Vec2d {
  double x = 0, y = 0;
  friend constexpr bool operator==(const Vec2d&, const Vec2d&) = default;
};

/// A convex polygon in counterclockwise order with inline storage; fewer than three points have no area.
struct ConvexPolygon {
  static constexpr size_t kCapacity = 32;
  std::array<Vec2d, kCapacity> points;
  size_t count = 0;

  void push(Vec2d p) { points[count++] = p; }
  std::span<const Vec2d> span() const { return {points.data(), count}; }
};

/// Shoelace area, >= 0.
double polygon_area(const ConvexPolygon& polygon);

/// The common part of two convex polygons (appendix A of the paper, by half-plane clipping: touching, contained and
/// degenerate polygons give their exact, possibly empty, result). Each input may have at most 16 points.
ConvexPolygon intersect_convex(const ConvexPolygon& a, const ConvexPolygon& b);

enum class Culling {
  kNone,    // the whole projection
  kWindow,  // only what lies in the area's window: rays outside it do not exist ("projected area culling")
};

/// An influence area with its derived geometry. Immutable; compute once, ask often.
///
/// The *projection* is a 2D plane: for a plane area the frame's (x, y), orthographic, in world units; for a point area
/// (x/z, y/z), perspective onto z = 1, after clipping to z >= near_z. The *window* is the rectangle of rays in it.
class AreaGeometry {
 public:
  explicit AreaGeometry(const InfluenceArea& area);  // validates

  const InfluenceArea& area() const { return area_; }
  const Frame& frame() const { return frame_; }
  const ConvexRegion& region() const { return region_; }
  bool is_plane() const { return std::holds_alternative<PlaneArea>(area_.shape); }

  /// Half extents of the window: half_width, half_height or tan(fov / 2).
  Vec2d window_half() const { return window_half_; }
  double window_area() const { return 4 * window_half_.x * window_half_.y; }

  /// Is the direction the area's, up to its tolerance, in either sense? For a point area the axis from the eye to the
  /// ray's origin; every direction is affine at the eye itself.
  bool is_direction_affine(const Ray& ray) const;

  /// A valid ray that is affine and starts inside the region, with tmin >= 0: what it meets at or before its exit
  /// distance then overlaps the region.
  bool serves(const Ray& ray) const;

  /// The travel direction of the area's rays at a point (not normalised; the axis for a plane area, and at the eye).
  Vec3d ray_direction(Vec3d point) const;

  /// The outline of a box as the area's rays see it, in the projection. For a point area a box that reaches before the
  /// near plane is clipped to z >= near_z first and may give an empty polygon; the far plane and the depth of a plane
  /// area do not matter. An empty box has an empty outline. Boxes must be finite.
  ConvexPolygon projected_hull(const Bounds& box, Culling culling) const;

  /// Area of `projected_hull`, computed faster where the box projects into the window. Never above `window_area` when
  /// culled.
  double projected_area(const Bounds& box, Culling culling) const;

  /// The part of the unit sphere about a point area's eye, in steradians, that `projected_hull` covers: how many rays
  /// of an isotropic light meet the box. kNone: of the part with |x|, |y| <= 65536, or as far as the window if that
  /// reaches farther; the flatter rays outside, 9e-5 steradians of the half sphere's 2 pi, are left out. Beside the
  /// rounding of the hull's points the relative error is below 2e-15 (1 + r^2) times the part's length over its width,
  /// r being its farthest point's distance from the projection's middle. Throws Error (kUsage) for a plane area, whose
  /// rays have no eye.
  double solid_angle(const Bounds& box, Culling culling) const;

  /// Of the whole window; relative error below 1e-14. Throws likewise.
  double window_solid_angle() const;

  /// Probability in [0, 1] that a ray uniform in the window, long enough to leave the region, meets the box within the
  /// region's z range: culled projected area of the part between near and far face over window area.
  double hit_probability(const Bounds& box) const;

 private:
  InfluenceArea area_;
  Frame frame_;
  ConvexRegion region_;
  Vec2d window_half_;
  double near_z_ = 0, far_z_ = 0;  // of the region, along the frame's forward axis
};

/// |direction| components of a unit direction: with face areas (A_yz, A_zx, A_xy) they give the orthographic projected
/// area of a box as a dot product.
Vec3d parallel_face_weights(Vec3d direction);

/// The same area as three parallelograms of projected edges (figure 11 of the paper).
double three_parallelogram_area(const Frame& frame, const Bounds& box);

/// The corners (numbered as in `corner`) on the outline of a box, counterclockwise in the (x, y) of a frame that looks
/// along the rays, from the faces that they see (algorithms 2 and 3 of the paper). `visible_faces` has bit k set where
/// face k is seen: 0 x=lo, 1 x=hi, 2 y=lo, 3 y=hi, 4 z=lo, 5 z=hi. At most 6 corners; none for impossible or empty
/// sets.
std::span<const int> contour_corners(unsigned visible_faces);

/// Visible faces for parallel rays of a travel direction, and for rays from a point (none from inside the box).
unsigned visible_faces_along(Vec3d direction);
unsigned visible_faces_from(Vec3d eye, const Bounds& box);

/// The plane area around `scene` for light that travels along `direction`: its window covers the scene's projection
/// with a margin of 0.1 % (more where the scene is flat), its depth the whole scene. Throws Error (kBadArea) for a zero
/// direction or an empty box.
InfluenceArea directional_light_area(const std::string& name, Vec3 direction, const Bounds& scene);

/// Six 90-degree frusta around a point (named NAME+x, NAME-x, NAME+y, ...) that together hold all directions and reach
/// all of `scene`; near_z is 1e-3 of the distance to the farthest corner. Throws Error (kBadArea) for an empty box.
std::vector<InfluenceArea> point_light_areas(const std::string& name, Vec3 position, const Bounds& scene);

/// The frustum of a camera that reaches all of `scene`: vertical field of view in degrees, aspect = width / height,
/// near_z as of point lights. Throws Error (kBadArea) where these make no frustum.
InfluenceArea camera_area(const std::string& name, Vec3 eye, Vec3 target, float fov_y, float aspect,
                          const Bounds& scene);

}  // namespace raygrain
