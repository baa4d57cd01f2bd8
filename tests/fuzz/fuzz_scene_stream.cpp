// The scene that another process of projection walls sends: any bytes give one that can be drawn, or an
// error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "game/view/scene_stream.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt;
    render::GpuModel model;
    model.parts.resize(2);
    model.parts[1].deformable.joint_boxes.resize(2);
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
    return 0;
}
