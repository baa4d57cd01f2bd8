// The part of the frame data that lighting needs. load_lit_frame() reads it from the frame block. light.frag
// runs per pixel and receives it through flat inputs instead: lavapipe (Mesa 22.3) gathers block values for
// each pixel, which took two fifths of the instructions. The third and later lights stay in the block.
#define LIT_INPUTS 25

struct LitFrame {
    mat4 world_from_clip;
    vec3 eye;
    float level_error_per_metre;  // error of levels of detail, m per metre of distance
    vec4 w_row;       // of clip_from_world: depth along the view
    vec4 shadow[3];   // rows of shadow_from_world
    vec4 environment;
    vec2 texel;  // 1/width, 1/height of the picture
    vec3 diffuse[9];
    Light light_0, light_1;
};

vec4 row(mat4 m, int i) { return vec4(m[0][i], m[1][i], m[2][i], m[3][i]); }

LitFrame load_lit_frame() {
    LitFrame f;
    const View view = frame.views[view_index];
    f.world_from_clip = view.world_from_clip;
    f.eye = view.eye.xyz;
    f.level_error_per_metre = frame.occlusion.y;
    f.w_row = row(view.clip_from_world, 3);
    for (int i = 0; i < 3; ++i) f.shadow[i] = row(frame.shadow_from_world, i);
    f.environment = frame.environment;
    f.texel = frame.picture.zw;
    for (int i = 0; i < 9; ++i) f.diffuse[i] = frame.diffuse[i].rgb;
    f.light_0 = frame.lights[0];
    f.light_1 = frame.lights[1];
    return f;
}

void pack(LitFrame f, out vec4 to[LIT_INPUTS]) {
    for (int i = 0; i < 4; ++i) to[i] = f.world_from_clip[i];
    to[4] = vec4(f.eye, f.level_error_per_metre);
    to[5] = f.w_row;
    for (int i = 0; i < 3; ++i) to[6 + i] = f.shadow[i];
    to[9] = f.environment;
    // Nine colours in seven rows: the seventh and eighth are stored in w of the first six.
    for (int i = 0; i < 6; ++i) to[10 + i] = vec4(f.diffuse[i], f.diffuse[6 + i / 3][i % 3]);
    to[16] = vec4(f.diffuse[8], 0.0);
    to[17] = vec4(f.texel, f.light_0.cone.xy);
    to[18] = f.light_0.position;
    to[19] = f.light_0.direction;
    to[20] = f.light_0.color;
    to[21] = f.light_1.position;
    to[22] = f.light_1.direction;
    to[23] = f.light_1.color;
    to[24] = vec4(f.light_1.cone.xy, 0.0, 0.0);
}

LitFrame unpack(vec4 from[LIT_INPUTS]) {
    LitFrame f;
    f.world_from_clip = mat4(from[0], from[1], from[2], from[3]);
    f.eye = from[4].xyz;
    f.level_error_per_metre = from[4].w;
    f.w_row = from[5];
    for (int i = 0; i < 3; ++i) f.shadow[i] = from[6 + i];
    f.environment = from[9];
    for (int i = 0; i < 6; ++i) f.diffuse[i] = from[10 + i].xyz;
    f.diffuse[6] = vec3(from[10].w, from[11].w, from[12].w);
    f.diffuse[7] = vec3(from[13].w, from[14].w, from[15].w);
    f.diffuse[8] = from[16].xyz;
    f.texel = from[17].xy;
    f.light_0 = Light(from[18], from[19], from[20], vec4(from[17].zw, 0.0, 0.0));
    f.light_1 = Light(from[21], from[22], from[23], vec4(from[24].xy, 0.0, 0.0));
    return f;
}
