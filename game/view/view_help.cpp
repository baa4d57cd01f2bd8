#include "game/view/view_help.hpp"

#include <memory>

#include "game/view/view_search.hpp"

namespace bolt::view {

motion::ViewHelp view_help() {
    return [sight = std::make_shared<motion::Sight>()](const motion::ViewAsk& ask) {
        view::Viewpoint now;
        now.eye = glm::vec3(ask.eye);
        now.target = glm::vec3(ask.nut);
        const ViewOf of{ask.setup, &ask.touch, ask.joint, ask.nut, ask.wrench};
        const view::Orbit orbit = find_view(of, *sight, view::orbit_of(now));
        return Vec3(view::viewpoint_of(orbit).eye);
    };
}

}  // namespace bolt::view
