// tiny_gltf.h as a library header: its own warnings are not ours.
#pragma once

#if defined(__GNUC__)
#pragma GCC system_header
#endif

#include <tiny_gltf.h>
