#include "game/sound/materials.hpp"

#include <algorithm>

#include "haptics/servo/touch.hpp"

namespace bolt::sound {

std::vector<Met> materials(const content::Assembly& assembly, std::span<const record::ObstacleName> names) {
    std::vector<Met> all;
    for (const record::ObstacleName& name : names) {
        if (name.id < 0 || name.id >= servo::first_nut) continue;
        const auto at = static_cast<std::size_t>(name.id);
        all.resize(std::max(all.size(), at + 1), Met::casing);
        const bool fastener = std::any_of(assembly.joints.begin(), assembly.joints.end(), [&](const auto& j) {
            return name.name.rfind(j.design.id + "_", 0) == 0;
        });
        if (fastener) all[at] = Met::nut;
    }
    return all;
}

}  // namespace bolt::sound
