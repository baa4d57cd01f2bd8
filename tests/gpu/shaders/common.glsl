// Shared by the test shaders: what a change here must reach through the build's dependencies.
const float half_size = 0.5;
