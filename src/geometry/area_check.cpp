#include <cmath>
#include <sstream>

#include "raygrain/area.h"
#include "raygrain/error.h"

namespace raygrain {

namespace {

class FieldCheck {
 public:
  explicit FieldCheck(const std::string& where) : where_(where) {}

  void finite(const char* field, Vec3 v) const {
    if (!is_finite(v)) fail(field, v, "must be finite");
  }
  void direction(const char* field, Vec3 v) const {
    finite(field, v);
    if (v == Vec3{}) fail(field, v, "must not be zero");
  }
  void positive(const char* field, float value) const {
    if (!(value > 0 && value < kInf)) fail(field, value, "must be positive and finite");
  }
  void field_of_view(const char* field, float degrees) const {
    if (!(degrees > 0 && degrees < 180)) fail(field, degrees, "must be above 0 and below 180 degrees");
  }
  void tolerance(float value) const {
    if (!(value >= 0 && value < 1)) fail("tolerance", value, "must be at least 0 and below 1");
  }
  void depth_range(float near_z, float far_z) const {
    positive("near_z", near_z);
    positive("far_z", far_z);
    if (!(near_z < far_z)) fail("near_z", near_z, "must be below far_z");
  }

 private:
  template <class Value>
  [[noreturn]] void fail(const char* field, const Value& value, const char* rule) const {
    std::ostringstream message;
    message << field << " is ";
    print(message, value);
    throw Error(ErrorCode::kBadArea, where_, message.str(), std::string(field) + " " + rule);
  }
  static void print(std::ostream& out, float value) { out << value; }
  static void print(std::ostream& out, Vec3 v) { out << "(" << v.x << ", " << v.y << ", " << v.z << ")"; }

  const std::string& where_;
};

void check(const FieldCheck& field, const PlaneArea& area) {
  field.finite("center", area.center);
  field.direction("direction", area.direction);
  field.finite("up", area.up);
  field.positive("half_width", area.half_width);
  field.positive("half_height", area.half_height);
  field.positive("depth", area.depth);
}

void check(const FieldCheck& field, const PointArea& area) {
  field.finite("eye", area.eye);
  field.direction("forward", area.forward);
  field.finite("up", area.up);
  field.field_of_view("fov_x", area.fov_x);
  field.field_of_view("fov_y", area.fov_y);
  field.depth_range(area.near_z, area.far_z);
}

}  // namespace

void validate(const InfluenceArea& area, const std::string& where) {
  const FieldCheck field(where);
  std::visit([&](const auto& shape) { check(field, shape); }, area.shape);
  field.tolerance(area.tolerance);
}

}  // namespace raygrain
