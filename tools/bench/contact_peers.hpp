// Other collision libraries behind one interface: does the wrench at a pose touch the casing?
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/collision/mesh.hpp"

namespace bolt::bench {

class Peer {
  public:
    Peer() = default;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    virtual ~Peer() = default;
    virtual bool touches(const Pose& tool) = 0;
};

using Parts = std::span<const collision::ContactMesh>;
using MakePeer = std::unique_ptr<Peer> (*)(Parts casing, Parts tool);

std::unique_ptr<Peer> make_fcl(Parts casing, Parts tool);
std::unique_ptr<Peer> make_bullet(Parts casing, Parts tool);

struct PeerEntry {
    std::string name;
    MakePeer make;
    std::size_t every;  // the library is queried for one in this many poses
};

// Returns the libraries that were found at build time.
std::vector<PeerEntry> peers();

}  // namespace bolt::bench
