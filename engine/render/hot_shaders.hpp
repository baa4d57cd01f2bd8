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

// SPIR-V by the shader's file name.
using ShaderCode = std::map<std::string, std::vector<std::uint32_t>>;

// Returns one of the renderer's shaders: the built-in one or its replacement. A replacement may omit bindings
// that the built-in shader uses (for example while its author lets it return red); they stay in its layout,
// because the passes bind them.
Result<gpu::Shader> load_shader(const std::string& name, const ShaderCode& replacements);

class HotShaders {
  public:
    // The folder must be named "shaders", because its files include each other by that name.
    static Result<HotShaders> open(const std::filesystem::path& folder);
    HotShaders(HotShaders&&) noexcept = default;
    HotShaders& operator=(HotShaders&&) noexcept;
    ~HotShaders();

    // Returns all shaders at the first call, and whenever one of them or of its includes has changed since
    // the last call; otherwise nullopt. An error contains the compiler's output; shaders compiled before stay
    // valid. `now`: s, from any monotonic clock.
    std::optional<Result<ShaderCode>> changed(double now);

  private:
    HotShaders() = default;
    Status compile(const std::string& name);
    void watch();

    std::filesystem::path folder_;
    std::filesystem::path output_folder_;  // of the compiler
    ShaderCode code_;
    // The files that each shader consists of.
    std::map<std::string, std::set<std::filesystem::path>> sources_;
    std::set<std::string> pending_;  // shaders to compile
    FileWatch watch_;
};

}  // namespace bolt::render
