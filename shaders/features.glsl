// What this pipeline is for: SCENE_… bits, known when it is compiled.
layout(constant_id = 0) const uint features = 0u;

bool has(uint feature) { return (features & feature) != 0u; }

// Which view is drawn. Of one that is drawn alone it is known when the shader is compiled: a place in a block that is not,
// lavapipe looks up for every pixel of its own.
#define view_index (has(SCENE_VIEWS) ? gl_ViewIndex : 0)
