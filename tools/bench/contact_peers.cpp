#include "tools/bench/contact_peers.hpp"

namespace bolt::bench {

std::vector<PeerEntry> peers() {
    return {
#ifdef BOLT_FCL
        {"fcl", make_fcl, 10},
#endif
#ifdef BOLT_BULLET
        {"bullet", make_bullet, 1000},
#endif
    };
}

}  // namespace bolt::bench
