// Light from all around: specular levels in a cube map, diffuse in spherical harmonics.
vec3 turned(vec3 d) {
    const float c = cos(frame.environment.y), s = sin(frame.environment.y);
    return vec3(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

vec3 diffuse_light(vec3 normal) {
    const vec3 n = turned(normal);
    const vec3 sum = frame.diffuse[0].rgb + frame.diffuse[1].rgb * n.y + frame.diffuse[2].rgb * n.z +
                     frame.diffuse[3].rgb * n.x + frame.diffuse[4].rgb * (n.x * n.y) + frame.diffuse[5].rgb * (n.y * n.z) +
                     frame.diffuse[6].rgb * (3.0 * n.z * n.z - 1.0) + frame.diffuse[7].rgb * (n.x * n.z) +
                     frame.diffuse[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0)) * frame.environment.x;
}

vec3 specular_light(samplerCube levels, vec3 direction, float roughness) {
    return textureLod(levels, turned(direction), roughness * frame.environment.z).rgb * frame.environment.x;
}
