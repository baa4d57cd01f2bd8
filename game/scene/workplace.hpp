// An assembly in its workshop, as entities.
#pragma once

#include "game/scene/components.hpp"
#include "game/scene/lesson_models.hpp"
#include "game/session/lesson_session.hpp"

namespace bolt::scene {

struct Workplace {
    World world;

    render::BoundingBox machine;  // m, of what is assembled
    glm::dmat4 workshop{1.0};
};

// The machine with its foot on the workshop's clamping plate, nuts where their joints have them, wrench and
// hand. Errors: a joint whose node or nut the model has not.
Result<Workplace> make_workplace(World world, const Shelf& shelf, const GpuShelf& on_gpu,
                                 const content::Assembly& assembly, const servo::Setup& setup);

}  // namespace bolt::scene
