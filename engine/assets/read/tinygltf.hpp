// Includes tiny_gltf.h with its warnings disabled.
#pragma once

#if defined(__GNUC__)
#pragma GCC system_header
#endif

#include <tiny_gltf.h>
