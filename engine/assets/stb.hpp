// The stb image headers (Debian's libstb-dev). stb.cpp compiles their implementation.
#pragma once

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
