// Other collision libraries, asked the same: whether, and where, the wrench at a pose touches the casing.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
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

// Those that were found when this was built, by name.
std::vector<std::pair<std::string, MakePeer>> peers();

}  // namespace bolt::bench
