// Other collision libraries, asked the same: whether, and where, the wrench at a pose touches the casing.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/pose.hpp"
#include "haptics/contact/mesh.hpp"

namespace bolt::bench {

class Peer {
  public:
    Peer() = default;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    virtual ~Peer() = default;
    virtual bool touches(const Pose& tool) = 0;
};

using Parts = std::span<const contact::ContactMesh>;
using MakePeer = std::unique_ptr<Peer> (*)(Parts casing, Parts tool);

std::unique_ptr<Peer> make_fcl(Parts casing, Parts tool);
std::unique_ptr<Peer> make_bullet(Parts casing, Parts tool);

struct PeerEntry {
    std::string name;
    MakePeer make;
    std::size_t every;  // of how many poses one is asked, for it takes long
};

// Those that were found when this was built.
std::vector<PeerEntry> peers();

}  // namespace bolt::bench
