// Khronos PBR Neutral (Khronos Group, 2024): colours below the shoulder keep their hue and saturation.
vec3 pbr_neutral(vec3 color) {
    const float start = 0.8 - 0.04;
    const float x = min(color.r, min(color.g, color.b));
    color -= x < 0.08 ? x - 6.25 * x * x : 0.04;
    const float peak = max(color.r, max(color.g, color.b));
    const float d = 1.0 - start;
    const float new_peak = peak < start ? peak : 1.0 - d * d / (peak + d - start);
    const float scale = peak < start ? 1.0 : new_peak / peak;
    return mix(color * scale, vec3(new_peak), 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0));
}
