// Passes over the whole picture as compute shaders, one invocation per pixel and view.
#define view_index int(gl_GlobalInvocationID.z)
layout(local_size_x = 8, local_size_y = 8) in;
