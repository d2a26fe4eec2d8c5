/// Compiled where Embree 3 or 4 is installed. Every triangle goes into one geometry with corners of its own,
/// so that the library's numbers are the object's; it copies what its nodes need, so shared corners would
/// change nothing.
#include "lab/peer.h"

#include <algorithm>
#include <atomic>

#if ALHAZEN_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include "lab/timing.h"

namespace alhazen {

namespace {

constexpr int packet = 16;

#if ALHAZEN_EMBREE >= 4
/// What a call is told of its rays.
struct IntersectHow {
    RTCIntersectArguments arguments;
    explicit IntersectHow(bool coherent) {
        rtcInitIntersectArguments(&arguments);
        arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
struct OccludedHow {
    RTCOccludedArguments arguments;
    explicit OccludedHow(bool coherent) {
        rtcInitOccludedArguments(&arguments);
        arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
void intersect(RTCScene scene, IntersectHow& how, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, &how.arguments);
}
void intersect(RTCScene scene, IntersectHow& how, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &how.arguments);
}
void occluded(RTCScene scene, OccludedHow& how, RTCRay& ray) {
    rtcOccluded1(scene, &ray, &how.arguments);
}
void occluded(RTCScene scene, OccludedHow& how, const int* valid, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &rays, &how.arguments);
}
#else
struct IntersectHow {
    RTCIntersectContext context;
    explicit IntersectHow(bool coherent) {
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
};
using OccludedHow = IntersectHow;
void intersect(RTCScene scene, IntersectHow& how, RTCRayHit& ray) {
    rtcIntersect1(scene, &how.context, &ray);
}
void intersect(RTCScene scene, IntersectHow& how, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &how.context, &rays);
}
void occluded(RTCScene scene, OccludedHow& how, RTCRay& ray) {
    rtcOccluded1(scene, &how.context, &ray);
}
void occluded(RTCScene scene, OccludedHow& how, const int* valid, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &how.context, &rays);
}
#endif

void set_ray(RTCRay& to, const Ray& from) {
    to.org_x = from.o.x;
    to.org_y = from.o.y;
    to.org_z = from.o.z;
    to.dir_x = from.d.x;
    to.dir_y = from.d.y;
    to.dir_z = from.d.z;
    to.tnear = 0;
    to.tfar = from.tmax;
    to.time = 0;
    to.mask = 0xffffffffu;
    to.id = 0;
    to.flags = 0;
}

void set_ray(RTCRay16& to, int k, const Ray& from) {
    to.org_x[k] = from.o.x;
    to.org_y[k] = from.o.y;
    to.org_z[k] = from.o.z;
    to.dir_x[k] = from.d.x;
    to.dir_y[k] = from.d.y;
    to.dir_z[k] = from.d.z;
    to.tnear[k] = 0;
    to.tfar[k] = from.tmax;
    to.time[k] = 0;
    to.mask[k] = 0xffffffffu;
    to.id[k] = 0;
    to.flags[k] = 0;
}

/// Calls body(first, valid) for each packet of rays; valid is -1 for lanes with a ray.
template <class Body>
void for_packets(std::size_t count, const Body& body) {
    alignas(64) int valid[packet];
    for (std::size_t first = 0; first < count; first += packet) {
        for (std::size_t k = 0; k < packet; ++k) valid[k] = first + k < count ? -1 : 0;
        body(first, valid);
    }
}

RTCBuildQuality quality_of(PeerQuality quality) {
    if (quality == PeerQuality::low) return RTC_BUILD_QUALITY_LOW;
    return quality == PeerQuality::medium ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH;
}

bool count_bytes(void* total, ssize_t bytes, bool) {
    static_cast<std::atomic<std::int64_t>*>(total)->fetch_add(bytes);
    return true;
}

class EmbreePeer final : public Peer {
  public:
    EmbreePeer(const Object& root, const PeerOptions& options)
        : is_avx2_(options.avx2),
          device_(rtcNewDevice(
              fmt::format("threads={}{}", options.threads, options.avx2 ? ",isa=avx2" : "").c_str())),
          scene_(rtcNewScene(device_)) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, quality_of(options.quality));
        fill(geometry, root);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneBuildQuality(scene_, quality_of(options.quality));
        rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
        seconds_ = seconds_of(options.threads, [&] { rtcCommitScene(scene_); });
    }
    EmbreePeer(const EmbreePeer&) = delete;
    EmbreePeer& operator=(const EmbreePeer&) = delete;
    ~EmbreePeer() override {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    std::string name() const override {
        return fmt::format("{} ({})", peer_library(), is_avx2_ ? "AVX2" : "its best instruction set");
    }
    double build_seconds() const override { return seconds_; }
    std::size_t bytes() const override { return static_cast<std::size_t>(std::max<std::int64_t>(bytes_, 0)); }

    void closest(std::span<const Ray> rays, std::span<Intersection> hits, PeerCall call) const override {
        IntersectHow how(call == PeerCall::packet16);
        if (call == PeerCall::packet16) return closest16(rays, hits, how);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            alignas(16) RTCRayHit r;
            set_ray(r.ray, rays[i]);
            r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            intersect(scene_, how, r);
            if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            hits[i] = {r.ray.tfar, r.hit.u, r.hit.v, r.hit.primID, 0};
        }
    }
    void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked, PeerCall call) const override {
        OccludedHow how(call == PeerCall::packet16);
        if (call == PeerCall::packet16) return any16(rays, blocked, how);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            alignas(16) RTCRay r;
            set_ray(r, rays[i]);
            occluded(scene_, how, r);
            blocked[i] = r.tfar < 0;
        }
    }

  private:
    static void fill(RTCGeometry geometry, const Object& root) {
        std::size_t count = root.count();
        auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
        for (std::uint32_t i = 0; i < count; ++i) {
            Corners c = root.corners(i);
            for (Vec3 p : {c.a, c.b, c.c})
                for (int axis = 0; axis < 3; ++axis) *corners++ = p[axis];
            for (std::uint32_t k = 0; k < 3; ++k) *indices++ = 3 * i + k;
        }
    }

    void closest16(std::span<const Ray> rays, std::span<Intersection> hits, IntersectHow& how) const {
        for_packets(rays.size(), [&](std::size_t first, const int* valid) {
            alignas(64) RTCRayHit16 r;
            for (int k = 0; k < packet; ++k) {
                set_ray(r.ray, k, rays[std::min(first + static_cast<std::size_t>(k), rays.size() - 1)]);
                r.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
                r.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
            }
            intersect(scene_, how, valid, r);
            for (int k = 0; k < packet; ++k)
                if (valid[k] && r.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID)
                    hits[first + static_cast<std::size_t>(k)] = {r.ray.tfar[k], r.hit.u[k], r.hit.v[k],
                                                                 r.hit.primID[k], 0};
        });
    }
    void any16(std::span<const Ray> rays, std::span<std::uint8_t> blocked, OccludedHow& how) const {
        for_packets(rays.size(), [&](std::size_t first, const int* valid) {
            alignas(64) RTCRay16 r;
            for (int k = 0; k < packet; ++k)
                set_ray(r, k, rays[std::min(first + static_cast<std::size_t>(k), rays.size() - 1)]);
            occluded(scene_, how, valid, r);
            for (int k = 0; k < packet; ++k)
                if (valid[k]) blocked[first + static_cast<std::size_t>(k)] = r.tfar[k] < 0;
        });
    }

    bool is_avx2_;
    std::atomic<std::int64_t> bytes_ = 0;
    RTCDevice device_;
    RTCScene scene_;
    double seconds_ = 0;
};

} // namespace

std::string peer_library() {
    return "Embree " RTC_VERSION_STRING;
}

std::unique_ptr<Peer> make_peer(const Object& root, const PeerOptions& options) {
    if (!is_mesh(root)) return nullptr;
    return std::make_unique<EmbreePeer>(root, options);
}

} // namespace alhazen
