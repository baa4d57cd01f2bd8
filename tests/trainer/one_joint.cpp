#include "tests/trainer/one_joint.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"

namespace bolt::test {

OneJoint::OneJoint(const char* assembly, const char* thread_direction) {
    namespace fs = std::filesystem;
    const fs::path one = folder_ / "one";
    fs::copy(content::content_folder() / "assemblies" / assembly, one);
    nlohmann::json file = nlohmann::json::parse(std::ifstream(one / "assembly.json"));
    nlohmann::json& joints = file["joints"];
    joints = {joints[0]};
    joints[0]["override"]["thread_direction"] = thread_direction;
    file["order"] = {joints[0]["id"]};
    nlohmann::json passes = nlohmann::json::array();
    for (const nlohmann::json& pass : file["passes"])
        if (pass["kind"] == "run_down" || pass.value("percent", 0) == 100) passes.push_back(pass);
    file["passes"] = passes;
    std::ofstream(one / "assembly.json") << file;
}

}  // namespace bolt::test
