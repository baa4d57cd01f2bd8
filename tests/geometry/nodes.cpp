// The nodes that joints name: existence, uniqueness, position, and systematic errors of the whole model.
#include <doctest/doctest.h>

#include <glm/gtc/quaternion.hpp>

#include "support.hpp"
#include "tools/author/geometry/check_model.hpp"

using namespace bolt;
using namespace geometry_test;

namespace {

const std::vector<Vec3> four = {{-50, 10, -40}, {50, 10, -40}, {50, 10, 40}, {-50, 10, 40}};

assets::Node& node_of(Machine& machine, const std::string& name) {
    return machine.model.nodes[static_cast<std::size_t>(machine.node(name))];
}

// Rotates and scales the whole model, as a wrong export does.
void transform(Machine& machine, const glm::quat& turn, float factor) {
    assets::Node root;
    root.name = "export";
    root.children = machine.model.roots;
    root.rotation = turn;
    root.scale = glm::vec3(factor);
    machine.model.nodes.push_back(root);
    machine.model.roots = {static_cast<int>(machine.model.nodes.size()) - 1};
}

}  // namespace

TEST_CASE("Geometry: a correct machine has no findings") {
    for (const std::vector<Vec3>& positions : {std::vector<Vec3>{{0, 0, 0}}, four}) {
        const CheckOutput output = check(Machine(positions));
        CHECK(all(output.errors) == "");
        CHECK(all(output.notes) == "");
    }
}

TEST_CASE("Geometry: an assembly without a model has no findings") {
    const CheckOutput output =
        check(Machine(), [](std::string& text) { replace(text, "  \"model\": \"machine.glb\",\n", ""); });
    CHECK(output.errors.empty());
}

TEST_CASE("Geometry: a missing, misspelt or duplicate node is reported") {
    Machine machine(four);
    const auto misspelt = [](std::string& text) { replace(text, "\"joint_B1\"", "\"jiont_B1\""); };
    CHECK(all(check(machine, misspelt).errors) ==
          R"(16:44: /joints/0/node: there is no node "jiont_B1" in the model; did you mean "joint_B1"?)");
    const auto strange = [](std::string& text) { replace(text, "\"joint_B2\"", "\"bolt two\""); };
    CHECK(
        all(check(machine, strange).errors) ==
        R"(17:44: /joints/1/node: there is no node "bolt two" in the model; expected one of joint_B1, joint_B2, joint_B3, joint_B4)");
    const auto none = [](std::string& text) { replace(text, "\"node\": \"joint_B4\", ", ""); };
    CHECK(
        all(check(machine, none).errors) ==
        R"(19:5: /joints/3: this joint names no node of the model; expected "node", the name of the node that shows it)");
    PrismMesh shape;
    shape.box({100, 0, 100}, {101, 1, 101});
    machine.add("joint_B3", shape);
    node_of(machine, "joint_B3");
    const auto twice = check(Machine(machine)).errors;
    CHECK(twice.front() ==
          R"(18:44: /joints/2/node: 2 nodes of the model are named "joint_B3"; expected one)");
}

TEST_CASE("Geometry: a node offset by 0.02 mm is an error, by 0.005 mm is not") {
    for (const double shift : {0.02, 0.005}) {
        Machine machine(four);
        node_of(machine, "joint_B2").translation += glm::vec3(Vec3{shift, 0.0, 0.0} * mm);
        const CheckOutput output = check(machine);
        CAPTURE(shift);
        if (shift < 0.01) {
            CHECK(all(output.errors) == "");
            continue;
        }
        REQUIRE(output.errors.size() == 1);
        CHECK(
            output.errors[0] ==
            R"(17:71: /joints/1/position_mm: the joint is [50, 10, -40] mm here, but its node "joint_B2" stands at [50.02, 10, -40] mm, 0.02 mm away; expected both within 0.01 mm)");
    }
}

TEST_CASE(
    "Geometry: an axis tilted by 0.2 degrees is an error, by 0.02 degrees is not, and a rotation about the "
    "axis is free") {
    for (const double angle : {0.2, 0.02, 180.0}) {
        Machine machine(four);
        node_of(machine, "joint_B1").rotation =
            glm::angleAxis(static_cast<float>(to_radians(angle)), glm::vec3(1.0F, 0.0F, 0.0F)) *
            glm::angleAxis(1.0F, glm::vec3(0.0F, 1.0F, 0.0F));
        const CheckOutput output = check(machine);
        CAPTURE(angle);
        if (angle == 0.02) {
            CHECK(all(output.errors) == "");
            continue;
        }
        REQUIRE(output.errors.size() == 1);
        CHECK(output.errors[0].find(angle > 1.0 ? "180 degrees off; expected the opposite direction"
                                                : "0.2 degrees off; expected both within 0.1 degrees") !=
              std::string::npos);
        CHECK(output.errors[0].starts_with(
            "16:5: /joints/0/axis: the axis is [0, 1, 0] here, but +Y of its node"));
    }
}

TEST_CASE("Geometry: a joint node that is scaled, mirrored or flattened is an error") {
    for (const glm::vec3& scale : {glm::vec3(1.01F), glm::vec3(-1.0F, 1.0F, 1.0F), glm::vec3(0.0F)}) {
        Machine machine(four);
        node_of(machine, "joint_B1").scale = scale;
        CHECK(
            all(check(machine).errors) ==
            R"(16:44: /joints/0/node: the node "joint_B1" is scaled, mirrored or skewed; expected a node that is only translated and rotated)");
    }
}

TEST_CASE("Geometry: a wrong unit or exchanged axes give one error at the model") {
    const glm::quat none(1.0F, 0.0F, 0.0F, 0.0F);
    const glm::quat z_up = glm::angleAxis(static_cast<float>(pi / 2), glm::vec3(1.0F, 0.0F, 0.0F));
    const auto only = [](const glm::quat& turn, double factor) {
        Machine machine(four);
        transform(machine, turn, static_cast<float>(factor));
        std::vector<std::string> errors = check(machine).errors;
        std::erase_if(errors, [](const std::string& e) { return e.find(": /model: ") == std::string::npos; });
        REQUIRE(errors.size() == 1);
        return errors[0];
    };
    CHECK(
        only(none, 1000.0) ==
        R"(4:12: /model: the model is in millimetres: "joint_B1" is at [-50000, 10000, -40000] mm in the model and at [-50, 10, -40] mm in the file; expected metres, as in glTF: scale the model by 0.001)");
    CHECK(only(none, 100.0).find("the model is in centimetres") != std::string::npos);
    CHECK(only(none, 1 / 0.0254).find("the model is in inches") != std::string::npos);
    CHECK(only(none, 25.4).find("25.4 times too large: millimetres were read as inches") !=
          std::string::npos);
    CHECK(only(none, 1 / 25.4).find("25.4 times too small: inches were read as") != std::string::npos);
    CHECK(only(none, 0.001).find("a thousand times too small") != std::string::npos);
    CHECK(
        only(z_up, 1.0) ==
        R"(4:12: /model: the model has Z up: "joint_B1" is at [-50, 40, 10] mm in the model and at [-50, 10, -40] mm in the file; expected Y up, as in glTF: bolt-author import-step converts it)");
    CHECK(only(glm::inverse(z_up), 1.0).find("its up is -Z") != std::string::npos);
    CHECK(only(z_up, 1000.0).find("in millimetres, and the model has Z up: ") != std::string::npos);
}

TEST_CASE("Geometry: no systematic error is reported if it explains no joint or only some") {
    using geometry::JointPlacement;
    const Vec3 up{0.0, 1.0, 0.0};
    std::vector<JointPlacement> placements;
    for (const Vec3& p : four) placements.push_back({p * mm, up, p * mm, up});
    CHECK_FALSE(geometry::find_systematic_error(placements));
    placements[0].model *= 1000.0;
    CHECK_FALSE(geometry::find_systematic_error(placements));
    REQUIRE(geometry::find_systematic_error(std::span(placements).first(1)));
    for (JointPlacement& p : placements) p.model = p.file + Vec3{0.0, 0.05, 0.0};
    CHECK(geometry::find_systematic_error(placements)->what == "the whole model is shifted by [0, 50, 0] mm");
    for (JointPlacement& p : placements) {
        p.model = p.file;
        p.file *= 1e-3;
    }
    CHECK(geometry::find_systematic_error(placements)->what == "position_mm is in metres");
    for (JointPlacement& p : placements)
        p = {p.model, up, Vec3{p.model.x, p.model.z, p.model.y}, Vec3{0.0, 0.0, 1.0}};
    CHECK(geometry::find_systematic_error(placements)->what ==
          "Y and Z are exchanged, which mirrors the model");
    placements.clear();
    for (const Vec3& p : four) placements.push_back({p * mm, up, p, Vec3{0.6, 0.8, 0.0}});
    CHECK_FALSE(geometry::find_systematic_error(placements));  // a factor of 1000, but the axes disagree
    CHECK_FALSE(geometry::find_systematic_error({}));
}
