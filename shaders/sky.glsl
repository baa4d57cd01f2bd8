// Returns the background at a pixel: a colour or the environment.
vec3 behind_all(vec2 pixel) {
    if (has(SCENE_PLAIN)) return pbr_neutral(frame.background.rgb * here.environment.w);
    const vec4 far = here.world_from_clip * vec4(pixel * here.texel * 2.0 - 1.0, 1e-6, 1.0);
    const vec3 way = far.xyz / far.w - here.eye;
    return pbr_neutral(specular_light(specular_levels, way, 0.0) * here.environment.w);
}
