// The picture at half the size: each of its texels stands for one sample of the large one, the one nearest to the middle of four
// pixels.
const int small_sample = 3;
const vec2 small_sample_place = vec2(0.625, 0.875);  // in its pixel: Vulkan's standard locations

ivec3 full_texel(ivec3 texel) { return ivec3(2 * texel.xy, texel.z); }

// Where in the picture it was seen, 0 … 1.
vec2 place_of(ivec2 texel) { return (2.0 * vec2(texel) + small_sample_place) * frame.picture.zw; }
