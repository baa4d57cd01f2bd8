// Shared by the test shaders. A change of this file must rebuild them through the build's dependencies.
const float half_size = 0.5;
