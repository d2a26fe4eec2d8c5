/// Another library's structure over the same triangles, to be measured beside ours: Intel's Embree (Wald et
/// al. 2014), where it was installed when this was built. For measurements only: nothing is rendered with it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "scene/object.h"

namespace alhazen {

enum class PeerQuality { low, medium, high };

struct PeerOptions {
    PeerQuality quality = PeerQuality::high;
    int threads = 1;
    bool avx2 = false; ///< instead of the best instruction set it finds, which is not always faster
};

/// How the peer is handed its rays.
enum class PeerCall { single, packet16 };

/// Immutable; may be asked from several threads.
class Peer {
  public:
    virtual ~Peer() = default;
    /// "Embree 3.13.5 (AVX2)"
    virtual std::string name() const = 0;
    virtual double build_seconds() const = 0; ///< as seconds_of measures them
    /// Memory that it took while building and kept.
    virtual std::size_t bytes() const = 0;
    /// As Structure's functions for many rays; primitives have root's numbers.
    virtual void closest(std::span<const Ray> rays, std::span<Intersection> hits, PeerCall call) const = 0;
    virtual void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked, PeerCall call) const = 0;
};

/// "Embree 3.13.5", or "" when there was none.
std::string peer_library();
/// nullptr without the library, or when not all of root's own primitives are triangles.
std::unique_ptr<Peer> make_peer(const Object& root, const PeerOptions& options);

/// Whether all of root's own primitives are triangles (cutouts among them), and there is at least one.
bool is_mesh(const Object& root);

} // namespace alhazen
