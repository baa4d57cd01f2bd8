// The structures with which OpenXR's loader and a runtime find each other. Debian 12 does not package
// openxr_loader_negotiation.h; the names are those of "OpenXR Loader - Design and Operation", Khronos.
#pragma once

#include <openxr/openxr.h>

#include <cstddef>
#include <cstdint>

namespace bolt::mock {

enum class LoaderStruct : std::uint32_t { loader_info = 1, api_layer_request = 2, runtime_request = 3 };

struct NegotiateLoaderInfo {
    LoaderStruct type = LoaderStruct::loader_info;
    std::uint32_t version = 1;
    std::size_t size = sizeof(NegotiateLoaderInfo);
    std::uint32_t min_interface = 1, max_interface = 1;
    XrVersion min_api = XR_MAKE_VERSION(1, 0, 0), max_api = XR_MAKE_VERSION(1, 0x3FF, 0xFFF);
};

struct NegotiateRuntimeRequest {
    LoaderStruct type = LoaderStruct::runtime_request;
    std::uint32_t version = 1;
    std::size_t size = sizeof(NegotiateRuntimeRequest);
    std::uint32_t interface = 0;
    XrVersion api = 0;
    PFN_xrGetInstanceProcAddr get_instance_proc_addr = nullptr;
};

}  // namespace bolt::mock
