// The nodes that joints name: there, once, in their place; and one slip behind many wrong places.
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

// Every root turned and scaled as one, as a wrong export does it.
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

TEST_CASE("a machine that is right: nothing is said") {
    for (const std::vector<Vec3>& positions : {std::vector<Vec3>{{0, 0, 0}}, four}) {
        const Said said = check(Machine(positions));
        CHECK(all(said.errors) == "");
        CHECK(all(said.notes) == "");
    }
}

TEST_CASE("an assembly without a model has no geometry to be wrong") {
    const Said said =
        check(Machine(), [](std::string& text) { replace(text, "  \"model\": \"machine.glb\",\n", ""); });
    CHECK(said.errors.empty());
}

TEST_CASE("a node that is missing, misspelt, or there twice") {
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
    Shape shape;
    shape.box({100, 0, 100}, {101, 1, 101});
    machine.add("joint_B3", shape);
    node_of(machine, "joint_B3");
    const auto twice = check(Machine(machine)).errors;
    CHECK(twice.front() ==
          R"(18:44: /joints/2/node: 2 nodes of the model are named "joint_B3"; expected one)");
}

TEST_CASE("a node that has moved by 0.02 mm is found, by 0.005 mm is not") {
    for (const double shift : {0.02, 0.005}) {
        Machine machine(four);
        node_of(machine, "joint_B2").translation += glm::vec3(Vec3{shift, 0.0, 0.0} * mm);
        const Said said = check(machine);
        CAPTURE(shift);
        if (shift < 0.01) {
            CHECK(all(said.errors) == "");
            continue;
        }
        REQUIRE(said.errors.size() == 1);
        CHECK(
            said.errors[0] ==
            R"(17:71: /joints/1/position_mm: the joint is [50, 10, -40] mm here, but its node "joint_B2" stands at [50.02, 10, -40] mm, 0.02 mm away; expected both within 0.01 mm)");
    }
}

TEST_CASE("an axis that is 0.2 degrees off is found, 0.02 degrees is not; a turn about the axis is free") {
    for (const double angle : {0.2, 0.02, 180.0}) {
        Machine machine(four);
        node_of(machine, "joint_B1").rotation =
            glm::angleAxis(static_cast<float>(to_radians(angle)), glm::vec3(1.0F, 0.0F, 0.0F)) *
            glm::angleAxis(1.0F, glm::vec3(0.0F, 1.0F, 0.0F));
        const Said said = check(machine);
        CAPTURE(angle);
        if (angle == 0.02) {
            CHECK(all(said.errors) == "");
            continue;
        }
        REQUIRE(said.errors.size() == 1);
        CHECK(said.errors[0].find(angle > 1.0 ? "180 degrees off; expected the opposite direction"
                                              : "0.2 degrees off; expected both within 0.1 degrees") !=
              std::string::npos);
        CHECK(said.errors[0].starts_with(
            "16:5: /joints/0/axis: the axis is [0, 1, 0] here, but +Y of its node"));
    }
}

TEST_CASE("a joint that is scaled, mirrored or flattened in its place") {
    for (const glm::vec3& scale : {glm::vec3(1.01F), glm::vec3(-1.0F, 1.0F, 1.0F), glm::vec3(0.0F)}) {
        Machine machine(four);
        node_of(machine, "joint_B1").scale = scale;
        CHECK(
            all(check(machine).errors) ==
            R"(16:44: /joints/0/node: the node "joint_B1" is scaled, mirrored or skewed; expected a node that is only moved and turned)");
    }
}

TEST_CASE("units that slipped and axes that are exchanged are said once, at the model") {
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
        R"(4:12: /model: the model is in millimetres: "joint_B1" stands at [-50000, 10000, -40000] mm, and the file has it at [-50, 10, -40] mm; expected metres, as glTF has them: scale it by 0.001)");
    CHECK(only(none, 100.0).find("the model is in centimetres") != std::string::npos);
    CHECK(only(none, 1 / 0.0254).find("the model is in inches") != std::string::npos);
    CHECK(only(none, 25.4).find("25.4 times too large: millimetres were taken for inches") !=
          std::string::npos);
    CHECK(only(none, 1 / 25.4).find("25.4 times too small: inches were taken for") != std::string::npos);
    CHECK(only(none, 0.001).find("a thousand times too small") != std::string::npos);
    CHECK(
        only(z_up, 1.0) ==
        R"(4:12: /model: the model has Z up: "joint_B1" stands at [-50, 40, 10] mm, and the file has it at [-50, 10, -40] mm; expected Y up, as glTF has it: bolt-author import-step turns it)");
    CHECK(only(glm::inverse(z_up), 1.0).find("its up is -Z") != std::string::npos);
    CHECK(only(z_up, 1000.0).find("in millimetres, and the model has Z up: ") != std::string::npos);
}

TEST_CASE("no slip is seen where there is none, or where it explains only some") {
    using geometry::Placement;
    const Vec3 up{0.0, 1.0, 0.0};
    std::vector<Placement> placements;
    for (const Vec3& p : four) placements.push_back({p * mm, up, p * mm, up});
    CHECK_FALSE(geometry::common_slip(placements));
    placements[0].model *= 1000.0;
    CHECK_FALSE(geometry::common_slip(placements));
    REQUIRE(geometry::common_slip(std::span(placements).first(1)));
    for (Placement& p : placements) p.model = p.file + Vec3{0.0, 0.05, 0.0};
    CHECK(geometry::common_slip(placements)->what == "the whole model is shifted by [0, 50, 0] mm");
    for (Placement& p : placements) {
        p.model = p.file;
        p.file *= 1e-3;
    }
    CHECK(geometry::common_slip(placements)->what == "position_mm is in metres");
    for (Placement& p : placements)
        p = {p.model, up, Vec3{p.model.x, p.model.z, p.model.y}, Vec3{0.0, 0.0, 1.0}};
    CHECK(geometry::common_slip(placements)->what == "Y and Z are exchanged, as in a mirror");
    placements.clear();
    for (const Vec3& p : four) placements.push_back({p * mm, up, p, Vec3{0.6, 0.8, 0.0}});
    CHECK_FALSE(geometry::common_slip(placements));  // a thousand times, but the axes say something else
    CHECK_FALSE(geometry::common_slip({}));
}
