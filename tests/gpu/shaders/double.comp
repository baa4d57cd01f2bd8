#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { uint values[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < uint(values.length())) values[i] *= 2u;
}
