// Labels in the layout that CPU and GPU share (see shared.h). engine/render/scene.hpp explains their meaning.
#ifndef BOLT_SHADERS_LABELS_H
#define BOLT_SHADERS_LABELS_H

#ifdef __cplusplus
#include "shaders/shared.h"
namespace bolt::render::shared {
#endif

struct LabelFrame {
    vec4 position;  // m; w: em size, m or pixels
    vec4 right;     // unit vector along a line of text, for LABEL_FIXED; w: LABEL_…
    vec4 up;        // unit vector up the text, for LABEL_FIXED; w: visible fraction behind parts
    vec4 pixels;    // xy: offset on the screen, pixels, y up; z: occlusion margin, m
};

#define LABEL_FIXED 0.0      // in the plane of right and up
#define LABEL_FACING 1.0     // turned to the eye, size in metres
#define LABEL_ON_SCREEN 2.0  // turned to the eye, size in pixels

// A glyph, or the background of a text.
struct LabelQuad {
    vec4 rect;   // em from the label's position: left, below, right, above
    vec4 uv;     // in the atlas, in the same order; for a background half of its width and height, em
    vec4 color;  // linear, straight alpha
    float grow;  // em: extent beyond the glyph's edge; for a background its corner radius
    uint label;  // index of its LabelFrame
    uint plate;  // 1: a background
    uint unused;
};

#ifdef __cplusplus
}  // namespace bolt::render::shared
#endif
#endif
