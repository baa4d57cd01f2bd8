#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wall"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_FAILURE_USERMSG
#include "engine/assets/stb.hpp"
