#include "embree_engine.h"

#include <algorithm>
#include <atomic>

#include <embree3/rtcore.h>
#include <immintrin.h>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/timer.h"

namespace raygrain::bench {

struct EmbreeScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<int64_t> bytes{0};
  double seconds = 0;
};

namespace {

constexpr size_t kRaysPerTask = 1024;

/// Embree asks for this; raygrain is measured without.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  unsigned before_;
};

bool count_bytes(void* counter, ssize_t bytes, bool) {
  *static_cast<std::atomic<int64_t>*>(counter) += bytes;
  return true;
}

RTCIntersectContext context_of(const EmbreeMode& mode) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = mode.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

RTCRay to_embree(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z, r.tnear = ray.tmin;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z, r.time = 0;
  r.tfar = ray.tmax, r.mask = 0xffffffffu, r.id = 0, r.flags = 0;
  return r;
}

template <class Packet>
void fill(Packet& packet, size_t lane, const Ray& ray) {
  packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
  packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y, packet.dir_z[lane] = ray.direction.z;
  packet.tnear[lane] = ray.tmin, packet.tfar[lane] = ray.tmax, packet.time[lane] = 0;
  packet.mask[lane] = 0xffffffffu, packet.id[lane] = 0, packet.flags[lane] = 0;
}

void intersect_singly(RTCScene scene, const EmbreeMode& mode, std::span<const Ray> rays, Hit* hits) {
  RTCIntersectContext context = context_of(mode);
  for (size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit query;
    query.ray = to_embree(rays[i]);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    const bool is_hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    hits[i] = is_hit ? Hit{query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID} : Hit{};
  }
}

void occluded_singly(RTCScene scene, const EmbreeMode& mode, std::span<const Ray> rays, uint8_t* flags) {
  RTCIntersectContext context = context_of(mode);
  for (size_t i = 0; i < rays.size(); ++i) {
    RTCRay query = to_embree(rays[i]);
    rtcOccluded1(scene, &context, &query);
    flags[i] = query.tfar < 0;
  }
}

template <unsigned kSize, class Packet, class Call>
void intersect_packets(const Call& call, std::span<const Ray> rays, Hit* hits) {
  for (size_t begin = 0; begin < rays.size(); begin += kSize) {
    const size_t count = std::min<size_t>(kSize, rays.size() - begin);
    alignas(64) int valid[kSize];
    alignas(64) Packet packet;
    for (size_t i = 0; i < kSize; ++i) {
      valid[i] = i < count ? -1 : 0;
      fill(packet.ray, i, rays[begin + std::min(i, count - 1)]);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    call(valid, &packet);
    for (size_t i = 0; i < count; ++i)
      hits[begin + i] = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID
                            ? Hit{packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i], packet.hit.primID[i]}
                            : Hit{};
  }
}

template <unsigned kSize, class Packet, class Call>
void occluded_packets(const Call& call, std::span<const Ray> rays, uint8_t* flags) {
  for (size_t begin = 0; begin < rays.size(); begin += kSize) {
    const size_t count = std::min<size_t>(kSize, rays.size() - begin);
    alignas(64) int valid[kSize];
    alignas(64) Packet packet;
    for (size_t i = 0; i < kSize; ++i) {
      valid[i] = i < count ? -1 : 0;
      fill(packet, i, rays[begin + std::min(i, count - 1)]);
    }
    call(valid, &packet);
    for (size_t i = 0; i < count; ++i) flags[begin + i] = packet.tfar[i] < 0;
  }
}

}  // namespace

std::string EmbreeMode::name() const {
  return std::string(high ? "high" : "medium") + (robust ? " robust " : " ") + std::to_string(packet) +
         (coherent ? " coherent" : " incoherent");
}

std::vector<EmbreeMode> embree_modes() {
  std::vector<EmbreeMode> modes;
  for (const bool high : {false, true})
    for (const bool robust : {false, true})
      for (const bool coherent : {false, true})
        for (const unsigned packet : {1u, 8u, 16u}) modes.push_back({high, robust, coherent, packet});
  return modes;
}

EmbreeScene::EmbreeScene(const TriangleMesh& mesh, bool high, bool robust, unsigned threads)
    : state_(std::make_unique<State>()) {
  const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
  state_->device = rtcNewDevice(config.c_str());
  if (state_->device == nullptr) throw Error(ErrorCode::kUnsupported, "Embree", "gives no device");
  rtcSetDeviceMemoryMonitorFunction(state_->device, count_bytes, &state_->bytes);
  const FlushDenormals flush;
  const Timer timer;
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneBuildQuality(state_->scene, high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
  rtcSetSceneFlags(state_->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(), 0,
                             sizeof(Vec3), mesh.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             sizeof(mesh.triangles[0]), mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state_->scene);
  state_->seconds = timer.seconds();
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

double EmbreeScene::build_seconds() const {
  return state_->seconds;
}

size_t EmbreeScene::memory_bytes() const {
  return static_cast<size_t>(state_->bytes.load());
}

void EmbreeScene::intersect(const EmbreeMode& mode, std::span<const Ray> rays, std::span<Hit> hits,
                            unsigned threads) const {
  parallel_for(rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    const std::span<const Ray> part = rays.subspan(begin, end - begin);
    RTCIntersectContext context = context_of(mode);
    if (mode.packet == 1) return intersect_singly(state_->scene, mode, part, hits.data() + begin);
    if (mode.packet == 8)
      return intersect_packets<8, RTCRayHit8>(
          [&](const int* valid, RTCRayHit8* packet) { rtcIntersect8(valid, state_->scene, &context, packet); }, part,
          hits.data() + begin);
    intersect_packets<16, RTCRayHit16>(
        [&](const int* valid, RTCRayHit16* packet) { rtcIntersect16(valid, state_->scene, &context, packet); }, part,
        hits.data() + begin);
  });
}

void EmbreeScene::occluded(const EmbreeMode& mode, std::span<const Ray> rays, std::span<uint8_t> flags,
                           unsigned threads) const {
  parallel_for(rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    const std::span<const Ray> part = rays.subspan(begin, end - begin);
    RTCIntersectContext context = context_of(mode);
    if (mode.packet == 1) return occluded_singly(state_->scene, mode, part, flags.data() + begin);
    if (mode.packet == 8)
      return occluded_packets<8, RTCRay8>(
          [&](const int* valid, RTCRay8* packet) { rtcOccluded8(valid, state_->scene, &context, packet); }, part,
          flags.data() + begin);
    occluded_packets<16, RTCRay16>(
        [&](const int* valid, RTCRay16* packet) { rtcOccluded16(valid, state_->scene, &context, packet); }, part,
        flags.data() + begin);
  });
}

}  // namespace raygrain::bench
