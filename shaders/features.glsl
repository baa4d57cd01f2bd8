// What this pipeline is for: SCENE_… bits, known when it is compiled.
layout(constant_id = 0) const uint features = 0u;

bool has(uint feature) { return (features & feature) != 0u; }
