// Returns the background at a pixel: a colour or the environment.
vec3 background_color(vec2 pixel) {
    if (has(SCENE_COLOR_BACKGROUND)) return pbr_neutral(frame.background.rgb * lit_frame.environment.w);
    const vec4 far = lit_frame.world_from_clip * vec4(pixel * lit_frame.texel * 2.0 - 1.0, 1e-6, 1.0);
    const vec3 direction = far.xyz / far.w - lit_frame.eye;
    return pbr_neutral(specular_light(specular_levels, direction, 0.0) * lit_frame.environment.w);
}
