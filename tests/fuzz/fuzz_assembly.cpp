// The assembly loader with arbitrary bytes: it returns, and each error of a rejected text has a position.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/format/assembly.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
    // Only some files define "stainless"; a missing variant is an error too.
    for (const char* variant : {"", "stainless"}) {
        const auto loaded = bolt::content::parse_assembly(text, "fuzz", variant);
        if (loaded.ok() && loaded.assembly.joints.empty()) std::abort();
        for (const bolt::Error& error : loaded.errors)
            if (error.line < 1 || error.line > lines || error.column < 1 || error.what.empty()) std::abort();
        for (const bolt::content::Pass& pass : loaded.assembly.passes)
            for (const std::size_t joint : pass.order)
                if (joint >= loaded.assembly.joints.size()) std::abort();
    }
    return 0;
}
