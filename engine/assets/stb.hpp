// The stb image headers (Debian's libstb-dev), declared here and compiled in stb.cpp.
#pragma once

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
