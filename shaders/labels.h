// Text in the scene, as CPU and GPU share it: see shared.h for how, engine/render/label_batch.hpp for what.
#ifndef BOLT_SHADERS_LABELS_H
#define BOLT_SHADERS_LABELS_H

#ifdef __cplusplus
#include "shaders/shared.h"
namespace bolt::render::shared {
#endif

struct LabelFrame {
    vec4 position;  // m; w: height of an em, m or pixels
    vec4 right;     // along a line of text, length 1; w: LABEL_…
    vec4 up;        // w: how much shows through parts in front of it
    vec4 pixels;    // xy: moved on the screen, y up; z: m towards the eye, when it is held against the depth of parts
};

#define LABEL_FIXED 0.0     // lies in the plane of right and up
#define LABEL_FACING 1.0    // turned to the eye, height in metres
#define LABEL_ON_SCREEN 2.0 // turned to the eye, height in pixels

// A glyph, or the plate behind a text.
struct LabelQuad {
    vec4 rect;   // em from the label's position: left, below, right, above
    vec4 uv;     // of the atlas, likewise; a plate: half of its width and height, em
    vec4 color;  // linear, not multiplied by its alpha
    float grow;  // em: how far it reaches beyond the glyph's edge; of a plate the radius of its corners
    uint label;
    uint plate;  // 1: it is one
    uint unused;
};

#ifdef __cplusplus
}  // namespace bolt::render::shared
#endif
#endif
