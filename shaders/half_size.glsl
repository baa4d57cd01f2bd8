// The half-size picture. Each texel holds one sample of the full-size picture: of the samples of four pixels,
// the one nearest to their common corner.
const int small_sample = 3;
const vec2 small_sample_place = vec2(0.625, 0.875);  // within its pixel: Vulkan's standard locations

ivec3 full_texel(ivec3 texel) { return ivec3(2 * texel.xy, texel.z); }

// The sample's position in the picture, 0 … 1.
vec2 sample_uv(ivec2 texel) { return (2.0 * vec2(texel) + small_sample_place) * frame.picture.zw; }
