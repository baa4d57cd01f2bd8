// What stands between an eye and the place that it wants to see fades: inside a cone from the eye to that place.
//
// 0: as it is … 1: gone.
float faded(vec3 at) {
    const vec3 eye = frame.views[view_index].eye.xyz;
    const vec3 way = frame.cut.xyz - eye, p = at - eye;
    const float distance2 = dot(way, way);
    const float t = dot(p, way) / distance2;
    const float off = length(p - t * way);
    const float radius = frame.cut.w * max(t, 0.0);
    const float beside = 1.0 - smoothstep(0.6 * radius, radius, off);
    // Up to a radius before the place nothing is left; the place itself stays whole.
    const float margin = frame.cut.w * inversesqrt(distance2);
    const float before = smoothstep(0.6 * margin, margin, 1.0 - t);
    return t > 0.0 ? frame.cut_strength * beside * before : 0.0;
}
