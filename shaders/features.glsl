// The features of this pipeline: SCENE_… bits, a specialization constant.
layout(constant_id = 0) const uint features = 0u;

bool has(uint feature) { return (features & feature) != 0u; }

// The index of the view. A pipeline with one view uses a constant; otherwise lavapipe would compute an index
// into the block for every pixel.
#ifndef view_index
#define view_index (has(SCENE_VIEWS) ? gl_ViewIndex : 0)
#endif
