#include "game/sound/materials.hpp"

#include <algorithm>

#include "haptics/servo/tool_contact.hpp"

namespace bolt::sound {

std::vector<Met> materials(const content::Assembly& assembly, std::span<const session::ObstacleName> names) {
    std::vector<Met> all;
    for (const session::ObstacleName& name : names) {
        if (!name.id.is_fixed()) continue;
        const std::size_t at = name.id.index();
        all.resize(std::max(all.size(), at + 1), Met::casing);
        const bool fastener = std::any_of(assembly.joints.begin(), assembly.joints.end(), [&](const auto& j) {
            return name.name.rfind(j.design.id + "_", 0) == 0;
        });
        if (fastener) all[at] = Met::nut;
    }
    return all;
}

}  // namespace bolt::sound
