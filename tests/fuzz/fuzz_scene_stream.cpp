// What another process of projection walls sends: any bytes give a scene that can be drawn, tiles that are in
// their panel, or an error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "game/view/panel_stream.hpp"
#include "game/view/scene_stream.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt;
    render::GpuModel model;
    model.parts.resize(2);
    model.parts[1].deformable.joints.resize(2);
    model.meshes = {{0, 1}, {1, 1}};
    const render::EnvironmentLight light;
    const view::StreamedModels models{{&model}, &light};
    const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
    cluster::MessageReader message(bytes);
    render::Scene scene;
    while (view::read_scene(message, models, scene)) {
        for (const render::Object& object : scene.objects) {
            if (object.model != &model || object.mesh > 1 || !std::isfinite(object.world[3][0])) std::abort();
            if (object.mesh == 1 && object.deformation && object.deformation->joints.size() < 2) std::abort();
        }
        if (message.size() == 0) break;
    }
    const VkExtent2D extent{130, 70};
    cluster::MessageReader panel(bytes);
    if (const auto tiles = view::get_tiles(panel, extent))
        for (const view::PanelTile& tile : *tiles)
            if (tile.column > 2 || tile.row > 1 || tile.texels.size() > 64 * 64 * 4) std::abort();
    return 0;
}
