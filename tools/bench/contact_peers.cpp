#include "tools/bench/contact_peers.hpp"

namespace bolt::bench {

std::vector<std::pair<std::string, MakePeer>> peers() {
    return {
#ifdef BOLT_FCL
        {"fcl", make_fcl},
#endif
#ifdef BOLT_BULLET
        {"bullet", make_bullet},
#endif
    };
}

}  // namespace bolt::bench
