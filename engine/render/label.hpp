// Text that stands in the scene: names of joints, the torque at the wrench.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>

namespace bolt::render {

enum class LabelStand : std::uint8_t {
    fixed,      // lies in the scene as `turn` says
    facing,     // turned to the eye, as high as it is in the scene
    on_screen,  // turned to the eye, equally high at every distance
};

// Colours are as on a screen (sRGB, alpha not multiplied in), over the finished picture: no light falls on
// text.
struct Label {
    std::string text;  // UTF-8; lines end with \n
    glm::vec3 position{0.0F};
    LabelStand stand = LabelStand::on_screen;
    glm::quat turn{1.0F, 0.0F, 0.0F,
                   0.0F};  // `fixed`: of a text that runs along x, with y up and seen from z
    float height = 16.0F;  // of an em: pixels on the screen, else m
    // Which point of the text is at `position`: (0, 0) its lower left corner, (1, 1) its upper right one.
    // Lines are aligned likewise.
    glm::vec2 anchor{0.5F, 0.5F};
    glm::vec2 moved_px{0.0F};  // on the screen, to the right and up
    glm::vec4 color{1.0F};
    glm::vec4 outline{0.0F};      // no outline without alpha
    float outline_width = 0.06F;  // em, up to 0.1
    glm::vec4 plate{0.0F};        // behind the text; none without alpha
    // How much is seen of it where parts are in front: 0 nothing, 1 all of it. Ghosts hide it as whole parts
    // do.
    float through = 0.0F;
    float before = 0.0F;  // m: parts that are no further in front than this do not hide it
};

}  // namespace bolt::render
