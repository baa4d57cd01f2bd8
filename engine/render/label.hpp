// Text in the scene, such as the names of joints and the torque at the wrench.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>

namespace bolt::render {

enum class LabelPlacement : std::uint8_t {
    fixed,      // oriented by `turn`
    facing,     // turned to the eye, with a fixed size in the scene
    on_screen,  // turned to the eye, with a fixed size on the screen
};

// Text is drawn over the finished picture and is not lit. Colours are screen colours (sRGB, straight alpha).
struct Label {
    std::string text;  // UTF-8; lines end with \n
    glm::vec3 position{0.0F};
    LabelPlacement stand = LabelPlacement::on_screen;
    glm::quat turn{1.0F, 0.0F, 0.0F, 0.0F};  // `fixed`: turns a text along x, with y up, seen from +z
    float height = 16.0F;                    // em size: pixels for `on_screen`, otherwise m
    // The point of the text at `position`: (0, 0) is its lower left corner, (1, 1) its upper right one. Lines
    // are aligned the same way.
    glm::vec2 anchor{0.5F, 0.5F};
    glm::vec2 moved_px{0.0F};  // offset on the screen, to the right and up
    glm::vec4 color{1.0F};
    glm::vec4 outline{0.0F};      // alpha 0: no outline
    float outline_width = 0.06F;  // em, up to 0.1
    glm::vec4 plate{0.0F};        // background behind the text; alpha 0: none
    // Visible fraction behind other parts: 0 hidden, 1 fully visible. Ghosts hide text like opaque parts.
    float through = 0.0F;
    float before = 0.0F;  // m: parts hide the text only if they are farther in front than this
};

}  // namespace bolt::render
