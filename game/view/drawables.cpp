#include "game/view/drawables.hpp"

namespace bolt::view {

void collect_objects(const ReadDrawables& world, render::Scene& scene) {
    scene.objects.clear();
    const auto& drawables = world.pool<Drawable>();
    for (std::size_t i = 0; i < drawables.size(); ++i) {
        const ecs::Entity entity = drawables.entities()[i];
        const Drawable& drawn = drawables.components()[i];
        const auto* transform = world.find<Transform>(entity);
        const auto* appearance = world.find<Appearance>(entity);
        if (transform == nullptr || (appearance != nullptr && appearance->hidden)) continue;
        render::Object object;
        object.model = drawn.model;
        object.mesh = drawn.mesh;
        object.node = drawn.node;
        object.moves = drawn.moves;
        object.deformation = drawn.deformation;
        object.world = transform->world;
        if (appearance != nullptr) {
            object.tint = appearance->tint;
            object.opacity = appearance->opacity;
        }
        if (const auto* outline = world.find<Outline>(entity)) object.outline = outline->color;
        if (const auto* fade = world.find<Fadable>(entity)) object.cut = fade->fades;
        scene.objects.push_back(std::move(object));
    }
}

}  // namespace bolt::view
