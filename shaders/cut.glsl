// Objects fade inside a cone between an eye and the cut-away's focus. Returns how much the point `at` fades:
// 0 fully visible … 1 removed.
float cut_fade(vec3 at) {
    const vec3 eye = frame.views[view_index].eye.xyz;
    const vec3 to_focus = frame.cut.xyz - eye, p = at - eye;
    const float distance2 = dot(to_focus, to_focus);
    const float t = dot(p, to_focus) / distance2;
    const float off = length(p - t * to_focus);
    const float radius = frame.cut.w * max(t, 0.0);
    const float beside = 1.0 - smoothstep(0.6 * radius, radius, off);
    // Removes all that is more than one radius in front of the focus; the focus itself stays visible.
    const float margin = frame.cut.w * inversesqrt(distance2);
    const float before = smoothstep(0.6 * margin, margin, 1.0 - t);
    return t > 0.0 ? frame.cut_strength * beside * before : 0.0;
}
