#include "lab/opponents.h"

#include <algorithm>
#include <limits>

namespace alhazen {

namespace {

/// Times each way is timed to choose among them; the best counts.
constexpr int trials = 3;

} // namespace

Opponents::Opponents(const Object& root, int threads) : threads_(threads) {
    if (peer_library().empty())
        why_none_ = "Embree was not installed when this program was built";
    else if (!is_mesh(root))
        why_none_ = "the scene is not one of triangles alone, which is all that the comparison knows";
    if (!why_none_.empty()) return;
    for (bool avx2 : {false, true}) {
        peers_.push_back(make_peer(root, {PeerQuality::high, threads, avx2}));
        const Peer* peer = peers_.back().get();
        all_.push_back({peer, PeerCall::single, peer->name() + ", single rays"});
        all_.push_back({peer, PeerCall::packet16, peer->name() + ", packets of 16"});
    }
}

const Opponent* Opponents::fastest(RayKind kind, Query query, TraceMode mode, std::span<const Ray> rays) {
    if (all_.empty()) return nullptr;
    const Opponent*& chosen = chosen_[{kind, query, mode}];
    if (chosen) return chosen;
    std::vector<double> best(all_.size(), std::numeric_limits<double>::infinity());
    Answers answers;
    for (int trial = 0; trial < trials; ++trial)
        for (std::size_t i = 0; i < all_.size(); ++i)
            if (mode == TraceMode::batch || all_[i].call == PeerCall::single)
                best[i] =
                    std::min(best[i], trace(*all_[i].peer, query, all_[i].call, rays, threads_, answers));
    auto index = std::min_element(best.begin(), best.end()) - best.begin();
    return chosen = &all_[static_cast<std::size_t>(index)];
}

} // namespace alhazen
