// A frame as an ordered list of systems: free functions over the world and a context, run in the order of the
// list.
//
//   constexpr ecs::System<World, Frame> frame[] = {{"haptics", haptic_system}, {"lesson", lesson_system}};
//   ecs::run(frame, world, context);
#pragma once

#include <cstddef>
#include <string_view>

namespace bolt::ecs {

template <class World, class Context>
struct System {
    std::string_view name;
    void (*run)(World&, Context&) = nullptr;
};

// `around(name, run)` is called for each system and must call run(); use it for timing and tracing.
template <class World, class Context, std::size_t count, class Around>
void run(const System<World, Context> (&systems)[count], World& world, Context& context, Around&& around) {
    for (const System<World, Context>& system : systems)
        around(system.name, [&] { system.run(world, context); });
}

template <class World, class Context, std::size_t count>
void run(const System<World, Context> (&systems)[count], World& world, Context& context) {
    for (const System<World, Context>& system : systems) system.run(world, context);
}

}  // namespace bolt::ecs
