// The four joints of the cover, turned with an open end, a ring and a ratchet.
#pragma once

#include <doctest/doctest.h>

#include <utility>

#include "content/format/assembly.hpp"

namespace bolt::test {

inline content::Assembly cover_with_three_tools() {
    content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    content::Assembly& cover = loaded.assembly;
    content::Tool ring{"ring", {}, {}}, ratchet{"ratchet", {}, {}};
    ring.wrench.kind = content::ToolKind::ring_wrench;
    ring.wrench.head = content::ToolHeadKind::ring;
    ratchet.wrench.kind = content::ToolKind::ratchet;
    ratchet.wrench.head = content::ToolHeadKind::socket;
    ratchet.wrench.teeth = 24;
    for (content::Tool* tool : {&ring, &ratchet}) {
        tool->wrench.size = 0.013;
        tool->wrench.handle_length = 0.15;
        cover.tools.push_back(*tool);
    }
    cover.joints[1].tool = "ring";
    cover.joints[2].tool = "ratchet";
    return std::move(loaded.assembly);
}

}  // namespace bolt::test
