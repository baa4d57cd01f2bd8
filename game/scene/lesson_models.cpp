#include "game/scene/lesson_models.hpp"

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/radiance_file.hpp"
#include "game/scene/arrow.hpp"
#include "game/session/contact_models.hpp"

namespace bolt::scene {

namespace {

// What is on the shelf, or its name under what is missing.
assets::Model read_or_miss(const std::filesystem::path& file, std::vector<std::string>& missing) {
    Result<assets::Model> model = assets::read_gltf(file);
    if (model) return std::move(*model);
    missing.push_back(model.error().message());
    return {};
}

}  // namespace

Result<Shelf> load_shelf(const content::Assembly& assembly, hand::Side side) {
    Shelf shelf;
    view::LoadedSubject machine = view::load_subject(assembly.file);
    if (!machine.ok()) return fail(machine.errors.front());
    shelf.machine = std::move(machine.subject);
    const std::filesystem::path content = content::content_folder();
    shelf.workshop = read_or_miss(content / "environments/workshop.glb", shelf.missing);
    shelf.hand = read_or_miss(
        content / (side == hand::Side::left ? "hands/hand_left.glb" : "hands/hand_right.glb"), shelf.missing);
    if (!assembly.wrench.model.empty()) {
        shelf.wrench = read_or_miss(assembly.wrench.model, shelf.missing);
        BOLT_TRY_ASSIGN(const auto turn, session::wrench_turn(assembly.wrench));
        shelf.wrench_turn = turn;
    }
    Result<shading::RadianceImage> light = assets::read_hdr(content / "environments/workshop.hdr");
    if (light)
        shelf.light = std::move(*light);
    else
        shelf.missing.push_back(light.error().message());
    return shelf;
}

Result<std::unique_ptr<GpuShelf>> upload(gpu::Device& device, const Shelf& shelf) {
    auto on = std::make_unique<GpuShelf>();
    const auto put = [&](const assets::Model& model, render::GpuModel& to) -> Status {
        if (model.meshes.empty()) return {};
        BOLT_TRY_ASSIGN(auto up, render::upload_model(device, model, {true}));
        to = std::move(up);
        return {};
    };
    for (const auto& [model, to] : {std::pair{&shelf.machine.model, &on->machine},
                                    {&shelf.workshop, &on->workshop},
                                    {&shelf.wrench, &on->wrench},
                                    {&shelf.hand, &on->hand}})
        BOLT_TRY(put(*model, *to));
    BOLT_TRY(put(arrow_model(), on->arrows));
    BOLT_TRY_ASSIGN(auto light,
                    render::upload_environment(device, shelf.light ? *shelf.light : shading::studio()));
    on->light = std::move(light);
    return on;
}

}  // namespace bolt::scene
