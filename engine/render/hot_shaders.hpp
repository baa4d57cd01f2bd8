// Shaders compiled while the program runs, for those who write them: a folder with GLSL is watched, and what
// changes is compiled as cmake/shaders.cmake does it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/base/file_watch.hpp"
#include "engine/base/result.hpp"
#include "engine/gpu/pipeline.hpp"

namespace bolt::render {

// SPIR-V by file name: RendererOptions::shaders.
using ShaderCode = std::map<std::string, std::vector<std::uint32_t>>;

// One of the renderer's shaders: the one that is given instead, or the one built in. A shader in work may
// leave out what the finished one uses (it returns red at once); what passes bind stays in its layout all the
// same.
Result<gpu::Shader> take_shader(const std::string& name, const ShaderCode& instead);

class HotShaders {
  public:
    // The folder has to be called "shaders": by that name its files include each other.
    static Result<HotShaders> open(const std::filesystem::path& folder);
    HotShaders(HotShaders&&) noexcept = default;
    HotShaders& operator=(HotShaders&&) noexcept;
    ~HotShaders();

    // All shaders of the renderer, when one of them (or what it includes) has changed since the last call,
    // and at the first call. An error holds the compiler's words; what compiled before is still good then.
    // `now` as FileWatch has it.
    std::optional<Result<ShaderCode>> changed(double now);

  private:
    HotShaders() = default;
    Status compile(const std::string& name);
    void watch();

    std::filesystem::path folder_, work_;  // work: for the compiler's files
    ShaderCode code_;
    std::map<std::string, std::set<std::filesystem::path>> read_;  // by each shader
    std::set<std::string> waiting_;                                // to be compiled
    FileWatch watch_;
};

}  // namespace bolt::render
