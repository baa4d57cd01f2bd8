// The components of an entity that is drawn, in a shown model and in the workplace of a lesson.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>

#include "engine/ecs/system.hpp"
#include "engine/render/gpu_model.hpp"
#include "engine/render/scene.hpp"

namespace bolt::view {

// From the entity's own frame to the assembly's.
struct Transform {
    glm::mat4 world{1.0F};
};

// A mesh to draw.
struct Drawable {
    const render::GpuModel* model = nullptr;
    std::uint32_t mesh = 0;
    int node = -1;                                                     // in the model that it came from
    bool moves = false;                                                // its shadow is drawn again each frame
    std::shared_ptr<const render::Deformation> deformation = nullptr;  // null: rigid
};

// Differences of a drawable from the look of its model.
struct Appearance {
    glm::vec4 tint{0.0F};  // w: the fraction of the material's colour that it replaces
    float opacity = 1.0F;
    bool hidden = false;
};

// An outline that is visible through other parts.
struct Outline {
    glm::vec4 color{0.0F};
};

// A part that may fade where it hides the work (render::Scene::cut_away).
struct Fadable {
    bool fades = true;
};

// The world of a shown model. The world of a lesson has these components and others (scene::SceneWorld).
using ModelWorld = ecs::Registry<Transform, Drawable, Appearance, Outline, Fadable>;

using ReadDrawables =
    ecs::Access<const Transform, const Drawable, const Appearance, const Outline, const Fadable>;

// Creates an entity that is drawn as the object.
template <class World>
ecs::Entity add_drawable(World& world, const render::Object& object) {
    const ecs::Entity entity = world.create();
    world.template add<Transform>(entity, object.world);
    world.template add<Drawable>(entity, object.model, object.mesh, object.node, object.moves,
                                 object.deformation);
    return entity;
}

// The last system of a frame, in every program that draws: replaces the objects of the scene by the
// drawables, in the order in which they were created, and leaves lights, labels and background unchanged.
void collect_objects(const ReadDrawables& world, render::Scene& scene);

}  // namespace bolt::view
