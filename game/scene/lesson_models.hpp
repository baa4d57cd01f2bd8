// The models of a lesson: the machine, the workshop around it, the wrench and the hand.
#pragma once

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/render/environment_light.hpp"
#include "engine/render/gpu_model.hpp"
#include "game/view/loaded_model.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

// On the CPU. Everything but the machine's own model is optional: what an assembly does not name, or what is
// not installed, is left out and named in `missing`.
struct Shelf {
    view::Subject machine;
    assets::Model workshop, wrench, hand;
    std::optional<shading::RadianceImage> light;
    Quat wrench_turn{1.0, 0.0, 0.0, 0.0};  // from the frame of the wrench's model to the tool's
    std::vector<std::string> missing;
};

Result<Shelf> load_shelf(const content::Assembly& assembly, hand::Side side = hand::Side::right);

// The same on the GPU. Stays where it is made: entities point to the models.
struct GpuShelf {
    render::GpuModel machine, workshop, wrench, hand, arrows;
    render::EnvironmentLight light;
};

Result<std::unique_ptr<GpuShelf>> upload(gpu::Device& device, const Shelf& shelf);

}  // namespace bolt::scene
