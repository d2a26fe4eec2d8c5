/// Compiled where Embree is not installed.
#include "lab/peer.h"

namespace alhazen {

std::string peer_library() {
    return "";
}

std::unique_ptr<Peer> make_peer(const Object&, const PeerOptions&) {
    return nullptr;
}

} // namespace alhazen
