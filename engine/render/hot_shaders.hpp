// Shader hot reload for shader authors: watches a folder of GLSL files and recompiles changed ones with the
// options of cmake/shaders.cmake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/gpu/pipeline.hpp"

namespace bolt::render {

// SPIR-V by file name: RendererOptions::shaders.
using ShaderCode = std::map<std::string, std::vector<std::uint32_t>>;

// Returns one of the renderer's shaders: the given replacement or the built-in one. A replacement may leave
// out bindings that the built-in shader uses (for example while it returns red at once); they stay in its
// layout, because the passes bind them.
Result<gpu::Shader> load_shader(const std::string& name, const ShaderCode& instead);

class HotShaders {
  public:
    // The folder must be named "shaders", because its files include each other by that name.
    static Result<HotShaders> open(const std::filesystem::path& folder);
    HotShaders(HotShaders&&) noexcept = default;
    HotShaders& operator=(HotShaders&&) noexcept;
    ~HotShaders();

    // Returns all shaders of the renderer at the first call, and whenever one of them or its includes has
    // changed since the last call. An error holds the compiler's output; the shaders compiled before stay
    // valid. `now`: see FileWatch.
    std::optional<Result<ShaderCode>> changed(double now);

  private:
    HotShaders() = default;
    Status compile(const std::string& name);
    void watch();

    std::filesystem::path folder_, work_;  // work: the compiler's output folder
    ShaderCode code_;
    std::map<std::string, std::set<std::filesystem::path>> read_;  // the files that each shader includes
    std::set<std::string> waiting_;                                // shaders to compile
    FileWatch watch_;
};

}  // namespace bolt::render
