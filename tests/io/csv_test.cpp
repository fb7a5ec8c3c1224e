#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "base/random.h"
#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using test::error_of;
using test::get_file;
using test::put_file;

bool same_value(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

bool same_ray(const Ray& a, const Ray& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!same_value(a.origin[axis], b.origin[axis]) || !same_value(a.direction[axis], b.direction[axis])) return false;
  return same_value(a.tmin, b.tmin) && same_value(a.tmax, b.tmax);
}

std::vector<Ray> load_text(const std::string& text) {
  const test::TemporaryFolder folder;
  put_file(folder.file("rays.csv"), text);
  return load_rays(folder.file("rays.csv"));
}

TEST(Csv, RaysOfAnyBitsComeBack) {
  const test::TemporaryFolder folder;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Ray> rays(500);
    for (Ray& ray : rays) {
      uint32_t bits[8];
      for (uint32_t& word : bits) word = static_cast<uint32_t>(random.next());
      std::memcpy(static_cast<void*>(&ray), bits, sizeof ray);
    }
    rays[0] = {{-0.0f, 1e-45f, -1e-45f}, {kInf, -kInf, 0}, -kInf, kInf};
    save_rays(rays, folder.file("rays.csv"));
    const std::vector<Ray> loaded = load_rays(folder.file("rays.csv"));
    ASSERT_EQ(loaded.size(), rays.size());
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_ray(loaded[i], rays[i])) << "ray " << i;
  }
}

TEST(Csv, RaysAreReadAsPeopleWriteThem) {
  const Ray expected{{1, 2, 3}, {-4, 0.5f, 600}, 0, kInf};
  for (const char* text :
       {"ox,oy,oz,dx,dy,dz\n1,2,3,-4,.5,6e2\n", "ox,oy,oz,dx,dy,dz\n1,2,3,-4,.5,6e2",
        "\xef\xbb\xbfox,oy,oz,dx,dy,dz\r\n\r\n1,2,3,-4,.5,6e2\r\n  \r\n", "dz,dy,dx,oz,oy,ox\n600,+0.5,-4,3,2,1\n",
        "# my rays\n\nox , oy,oz,\tdx,dy,dz,tmax,tmin\n# one\n 1, 2 ,3,-4,0.5,600.0 , inf,0\n"}) {
    SCOPED_TRACE(text);
    const std::vector<Ray> rays = load_text(text);
    ASSERT_EQ(rays.size(), 1u);
    EXPECT_TRUE(same_ray(rays[0], expected));
  }
  EXPECT_TRUE(load_text("ox,oy,oz,dx,dy,dz\n").empty());
}

TEST(Csv, NumbersBeyondFloat) {
  const std::vector<Ray> rays = load_text("ox,oy,oz,dx,dy,dz\n1e-99,-1e-999,1e-40,nan,-inf,1\n");
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_TRUE(same_value(rays[0].origin.x, 0.0f));
  EXPECT_TRUE(same_value(rays[0].origin.y, -0.0f));
  EXPECT_TRUE(same_value(rays[0].origin.z, 1e-40f));
  EXPECT_TRUE(std::isnan(rays[0].direction.x));
  EXPECT_EQ(rays[0].direction.y, -kInf);
  const std::string zeros(400, '0');
  const std::vector<Ray> long_ones =
      load_text("ox,oy,oz,dx,dy,dz\n0." + zeros + "1,-0." + zeros + "1,0." + zeros + "1e401,1" + zeros + "e-400,1" +
                zeros + "e-999,1e-9999999999999999999\n");
  ASSERT_EQ(long_ones.size(), 1u);
  EXPECT_TRUE(same_value(long_ones[0].origin.x, 0.0f));
  EXPECT_TRUE(same_value(long_ones[0].origin.y, -0.0f));
  EXPECT_EQ(long_ones[0].origin.z, 1.0f);
  EXPECT_EQ(long_ones[0].direction.x, 1.0f);
  EXPECT_TRUE(same_value(long_ones[0].direction.y, 0.0f));
  EXPECT_TRUE(same_value(long_ones[0].direction.z, 0.0f));
}

TEST(Csv, ErrorsNameThePlace) {
  struct Row {
    const char *text, *place, *part;
  };
  const std::string header = "ox,oy,oz,dx,dy,dz\n";
  for (const Row& row : {Row{"", "", "empty"},
                         {"\n \n# nothing\n", "", "empty"},
                         {"ox,oy,oz,dx,dy\n", ":1", "\"dz\" is missing"},
                         {"1,2,3,4,5,6\n", ":1:1", "unknown column \"1\""},
                         {"ox,oy,oz,dx,dy,dz,speed\n", ":1:19", "unknown column \"speed\""},
                         {"ox,oy,oz,dx,dy,dz,ox\n", ":1:19", "twice"},
                         {"ox,oy,oz,dx,dy,dz,\n", ":1:19", "unknown column \"\""},
                         {"\nox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n1,2,3,4,x5,6\n", ":4:9", "\"x5\" is not a number"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5\n", ":2:10", "5 fields where the header has 6"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6,7\n", ":2:13", "more fields"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,,6\n", ":2:9", "an empty field is not a number"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6 7\n", ":2:11", "not a number"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,1e39\n", ":2:11", "\"1e39\" is beyond float32 (3.4e38)"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,1e9999\n", ":2:11", "\"1e9999\" is beyond float32 (3.4e38)"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,0.001e9999999999999999999\n", ":2:11", "is beyond float32"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,1e99x\n", ":2:11", "not a number"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,+-6\n", ":2:11", "not a number"},
                         {"ox,oy,oz,dx,dy,dz\n1,2,3,4,5,0x10\n", ":2:11", "not a number"},
                         {"ox;oy;oz;dx;dy;dz\n", ":1:1", "unknown column"}}) {
    SCOPED_TRACE(row.text);
    const test::TemporaryFolder folder;
    put_file(folder.file("rays.csv"), row.text);
    const Error error = error_of([&] { load_rays(folder.file("rays.csv")); });
    EXPECT_EQ(error.code, ErrorCode::kMalformed);
    EXPECT_EQ(error.where, folder.file("rays.csv") + row.place);
    EXPECT_NE(error.message.find(row.part), std::string::npos) << error.message;
  }
}

TEST(Csv, MissingAndUnreadableFiles) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(error_of([&] { load_rays(folder.file("none.csv")); }).code, ErrorCode::kNotFound);
  EXPECT_EQ(error_of([&] { load_rays(folder.path()); }).code, ErrorCode::kUnreadable);
  for (const char* device : {"/dev/zero", "/dev/urandom", "/dev/null"})  // two of them have no end
    EXPECT_EQ(error_of([&] { load_rays(device); }).code, ErrorCode::kUnreadable) << device;
}

TEST(Csv, RandomBytesNeverCrash) {
  const std::string valid = "ox,oy,oz,dx,dy,dz,tmin,tmax\n1,2,3,-4,.5,6e2,0,inf\n1,2,3,4,5,6,7,8\n";
  size_t refused = 0;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    std::string bytes = valid;
    for (int i = 0; i < 3; ++i) bytes[random.below(bytes.size())] = static_cast<char>(random.next());
    try {
      load_text(bytes);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code, ErrorCode::kMalformed);
    }
  }
  EXPECT_GT(refused, 100u);
}

TEST(Csv, Hits) {
  const test::TemporaryFolder folder;
  const std::vector<Hit> hits{{1.5f, 0.25f, 0.1f, 7}, {}, {1e-30f, 0, 1, 0xfffffffeu}};
  save_hits(hits, folder.file("hits.csv"));
  EXPECT_EQ(get_file(folder.file("hits.csv")), "t,u,v,triangle\n1.5,0.25,0.1,7\ninf,0,0,-1\n1e-30,0,1,4294967294\n");
}

}  // namespace
}  // namespace raygrain
