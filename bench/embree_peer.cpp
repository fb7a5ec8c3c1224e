#include <algorithm>
#include <array>
#include <atomic>

#include <embree3/rtcore.h>
#include <immintrin.h>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "peer.h"

namespace raygrain::bench {

namespace {

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

RTCIntersectContext context_of(const PeerMode& mode) {
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

Hit to_hit(const RTCRayHit& query) {
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
}

template <class Packet>
void fill(Packet& packet, size_t lane, const Ray& ray) {
  packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
  packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y, packet.dir_z[lane] = ray.direction.z;
  packet.tnear[lane] = ray.tmin, packet.tfar[lane] = ray.tmax, packet.time[lane] = 0;
  packet.mask[lane] = 0xffffffffu, packet.id[lane] = 0, packet.flags[lane] = 0;
}

void intersect_singly(RTCScene scene, const PeerMode& mode, std::span<const Ray> rays, Hit* hits) {
  RTCIntersectContext context = context_of(mode);
  for (size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit query;
    query.ray = to_embree(rays[i]);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    hits[i] = to_hit(query);
  }
}

void occluded_singly(RTCScene scene, const PeerMode& mode, std::span<const Ray> rays, uint8_t* flags) {
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

void intersect_streams(RTCScene scene, const PeerMode& mode, std::span<const Ray> rays, Hit* hits) {
  RTCIntersectContext context = context_of(mode);
  std::array<RTCRayHit, kStream> queries;
  for (size_t begin = 0; begin < rays.size(); begin += kStream) {
    const size_t count = std::min<size_t>(kStream, rays.size() - begin);
    for (size_t i = 0; i < count; ++i) {
      queries[i].ray = to_embree(rays[begin + i]);
      queries[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene, &context, queries.data(), static_cast<unsigned>(count), sizeof(RTCRayHit));
    for (size_t i = 0; i < count; ++i) hits[begin + i] = to_hit(queries[i]);
  }
}

void occluded_streams(RTCScene scene, const PeerMode& mode, std::span<const Ray> rays, uint8_t* flags) {
  RTCIntersectContext context = context_of(mode);
  std::array<RTCRay, kStream> queries;
  for (size_t begin = 0; begin < rays.size(); begin += kStream) {
    const size_t count = std::min<size_t>(kStream, rays.size() - begin);
    for (size_t i = 0; i < count; ++i) queries[i] = to_embree(rays[begin + i]);
    rtcOccluded1M(scene, &context, queries.data(), static_cast<unsigned>(count), sizeof(RTCRay));
    for (size_t i = 0; i < count; ++i) flags[begin + i] = queries[i].tfar < 0;
  }
}

RTCBuildQuality to_embree(PeerQuality quality) {
  switch (quality) {
    case PeerQuality::kLow:
      return RTC_BUILD_QUALITY_LOW;
    case PeerQuality::kMedium:
      return RTC_BUILD_QUALITY_MEDIUM;
    case PeerQuality::kHigh:
      return RTC_BUILD_QUALITY_HIGH;
  }
  return RTC_BUILD_QUALITY_MEDIUM;
}

/// One built scene.
class EmbreeScene {
 public:
  /// Builds on `threads` threads (0 = all).
  EmbreeScene(const TriangleMesh& mesh, PeerQuality quality, bool robust, unsigned threads) {
    const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
    device_ = rtcNewDevice(config.c_str());
    if (device_ == nullptr) throw Error(ErrorCode::kUnsupported, "Embree", "gives no device");
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    const FlushDenormals flush;
    const Timer timer;
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, to_embree(quality));
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    attach(mesh);
    rtcCommitScene(scene_);
    seconds_ = timer.seconds();
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }
  PeerBuild build() const { return {seconds_, static_cast<size_t>(bytes_.load())}; }

 private:
  void attach(const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(), 0,
                               sizeof(Vec3), mesh.vertices.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(mesh.triangles[0]), mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<int64_t> bytes_{0};
  double seconds_ = 0;
};

void trace_closest(RTCScene scene, const PeerMode& mode, const Part& part, size_t begin, size_t end) {
  const FlushDenormals flush;
  const std::span<const Ray> rays = part.rays.subspan(begin, end - begin);
  Hit* hits = part.hits.data() + begin;
  RTCIntersectContext context = context_of(mode);
  if (mode.packet == 1)
    intersect_singly(scene, mode, rays, hits);
  else if (mode.packet == kStream)
    intersect_streams(scene, mode, rays, hits);
  else if (mode.packet == 8)
    intersect_packets<8, RTCRayHit8>(
        [&](const int* valid, RTCRayHit8* packet) { rtcIntersect8(valid, scene, &context, packet); }, rays, hits);
  else
    intersect_packets<16, RTCRayHit16>(
        [&](const int* valid, RTCRayHit16* packet) { rtcIntersect16(valid, scene, &context, packet); }, rays, hits);
}

void trace_any(RTCScene scene, const PeerMode& mode, const Part& part, size_t begin, size_t end) {
  const FlushDenormals flush;
  const std::span<const Ray> rays = part.rays.subspan(begin, end - begin);
  uint8_t* flags = part.flags.data() + begin;
  RTCIntersectContext context = context_of(mode);
  if (mode.packet == 1)
    occluded_singly(scene, mode, rays, flags);
  else if (mode.packet == kStream)
    occluded_streams(scene, mode, rays, flags);
  else if (mode.packet == 8)
    occluded_packets<8, RTCRay8>(
        [&](const int* valid, RTCRay8* packet) { rtcOccluded8(valid, scene, &context, packet); }, rays, flags);
  else
    occluded_packets<16, RTCRay16>(
        [&](const int* valid, RTCRay16* packet) { rtcOccluded16(valid, scene, &context, packet); }, rays, flags);
}

}  // namespace

struct Peer::State {
  std::array<std::unique_ptr<EmbreeScene>, 4> scenes;  // high * 2 + robust

  RTCScene scene(const PeerMode& mode) const {
    return scenes[(mode.quality == PeerQuality::kHigh ? 2u : 0u) + (mode.robust ? 1u : 0u)]->scene();
  }
};

bool Peer::is_there() {
  return true;
}

Peer::Peer(const TriangleMesh& mesh) : state_(std::make_unique<State>()) {
  for (const bool high : {false, true})
    for (const bool robust : {false, true})
      state_->scenes[(high ? 2u : 0u) + (robust ? 1u : 0u)] =
          std::make_unique<EmbreeScene>(mesh, high ? PeerQuality::kHigh : PeerQuality::kMedium, robust, 0);
}
Peer::~Peer() = default;

std::vector<PeerMode> Peer::modes() {
  std::vector<PeerMode> modes;
  for (const PeerQuality quality : {PeerQuality::kMedium, PeerQuality::kHigh})
    for (const bool robust : {false, true})
      for (const bool coherent : {false, true})
        for (const unsigned packet : {1u, 8u, 16u, kStream}) modes.push_back({quality, robust, coherent, packet});
  return modes;
}

void Peer::trace(const PeerMode& mode, bool any, const Part& part, unsigned threads) const {
  const RTCScene scene = state_->scene(mode);
  parallel_for(part.rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    if (any)
      trace_any(scene, mode, part, begin, end);
    else
      trace_closest(scene, mode, part, begin, end);
  });
}

PeerBuild build_peer(const TriangleMesh& mesh, PeerQuality quality, unsigned threads) {
  return EmbreeScene(mesh, quality, false, threads).build();
}

}  // namespace raygrain::bench
