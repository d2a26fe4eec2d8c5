/// The peer's ways of tracing, and which is the fastest for a set of rays: that one is compared with.
#pragma once

#include <map>
#include <tuple>

#include "lab/peer.h"
#include "lab/ray_sets.h"
#include "lab/tracing.h"

namespace alhazen {

struct Opponent {
    const Peer* peer = nullptr;
    PeerCall call = PeerCall::single;
    std::string name;
};

/// The peer built for quality, with its best instruction set and with AVX2.
class Opponents {
  public:
    Opponents(const Object& root, int threads);

    /// The fastest for these rays: among single calls when mode is single, among single calls and packets
    /// when batch; found by timing once for each kind, query and mode. nullptr when there is none.
    const Opponent* fastest(RayKind kind, Query query, TraceMode mode, std::span<const Ray> rays);

    /// "" when there is none, and then why.
    std::string library() const { return all_.empty() ? "" : peer_library(); }
    const std::string& why_none() const { return why_none_; }

  private:
    int threads_;
    std::vector<std::unique_ptr<Peer>> peers_;
    std::vector<Opponent> all_;
    std::map<std::tuple<RayKind, Query, TraceMode>, const Opponent*> chosen_;
    std::string why_none_;
};

} // namespace alhazen
