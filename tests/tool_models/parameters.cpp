// Kinds, sizes, test torques and their messages.
#include <doctest/doctest.h>

#include "haptics/joint/fastener.hpp"
#include "support.hpp"

namespace tool_models_parameters_test {

using namespace tool_models_test;

namespace {

std::string error_of(ToolParameters p) {
    const auto made = completed(p);
    return made ? "" : made.error().message();
}

ToolParameters tool(ModelKind kind, double size_mm) {
    ToolParameters p;
    p.kind = kind;
    p.size = size_mm * mm;
    return p;
}

}  // namespace

TEST_CASE("Tool parameters: an unknown kind gives the nearest name, and every kind has a name") {
    CHECK(kind_named("rign").error().message() ==
          "there is no tool of the kind \"rign\"; did you mean \"ring\"?");
    CHECK(kind_named("hammer").error().message().find("expected open_end, ring") != std::string::npos);
    for (const KindInfo& info : model_kinds()) {
        CHECK(*kind_named(info.name) == info.kind);
        CHECK(info_of(info.kind).name == info.name);
    }
}

TEST_CASE("Tool parameters: every hexagon of an assembly's fasteners has a wrench of a standard size") {
    const auto sizes = standard_sizes(SizeMeasure::nut);
    CHECK(std::is_sorted(sizes.begin(), sizes.end()));
    for (const joint::FastenerSize& fastener : joint::fastener_sizes()) {
        CAPTURE(std::string(fastener.name));
        CHECK(std::any_of(sizes.begin(), sizes.end(),
                          [&](double size) { return std::abs(size * mm - fastener.across_flats) < 1e-9; }));
        CHECK(error_of(tool(ModelKind::open_end_wrench, fastener.across_flats / mm)) == "");
    }
}

TEST_CASE("Tool parameters: impossible values are refused with the nearest valid one") {
    CHECK(error_of(tool(ModelKind::ring_wrench, 65)) ==
          "ring of 65 mm: the size is out of range; expected 5.5 to 60 mm; the nearest is 60");
    CHECK(error_of(tool(ModelKind::hex_key, 1)) ==
          "hex_key of 1 mm: the size is out of range; expected 2 to 22 mm; the nearest is 2");
    CHECK(error_of(tool(ModelKind::extension_bar, 12)) ==
          "extension_bar of 12 mm: there is no such square drive; expected 12.5 mm, the nearest of 6.3, 10, "
          "12.5, 20, 25");
    CHECK(error_of(tool(ModelKind::ring_wrench, bolt::nan)).find("out of range") != std::string::npos);
    ToolParameters p = tool(ModelKind::ratchet, 24);
    p.teeth = 73;
    CHECK(error_of(p) == "a ratchet of 73 teeth is unknown; expected 24, 72, 90");
    p.teeth = 24;
    CHECK(error_of(p) == "");
    p.drive = 11.0 * mm;
    CHECK(error_of(p) == "there is no square drive of 11 mm; expected 6.3, 10, 12.5, 20, 25 mm");
    p = tool(ModelKind::open_end_wrench, 24);
    p.teeth = 24;
    CHECK(error_of(p) == "open_end has no ratchet, so it has no teeth; expected no number of teeth");
    p = tool(ModelKind::open_end_wrench, 24);
    p.length = 50.0 * mm;
    CHECK(error_of(p) == "open_end of 24 mm: a length of 50 mm is impossible; expected 122 to 2500 mm");
    p = tool(ModelKind::adaptor, 10);
    p.drive = 10.0 * mm;
    CHECK(error_of(p) == "an adaptor from 10 mm to the same drive; expected another drive");
    p = tool(ModelKind::ring_wrench, 24);
    p.adaptor_length = 60.0 * mm;
    CHECK(error_of(p) ==
          "ring takes no adaptor that lengthens it; expected a torque wrench with an open end");
    p = tool(ModelKind::click_torque_wrench, 24);
    p.adaptor_length = 10.0 * mm;
    CHECK(error_of(p) == "an adaptor of 10 mm is impossible; expected 20 to 300 mm");
}

TEST_CASE("Tool parameters: an adaptor lengthens a torque wrench between its insert and its holder") {
    const auto end_of = [](const ToolModelParts& parts, const char* name, bool far) {
        double end = far ? -1e9 : 1e9;
        for (const ToolModelPart& part : parts)
            for (const Shell& shell : part.shells)
                for (const Vec3& point : shell.points)
                    if (part.name == name) end = far ? std::max(end, point.x) : std::min(end, point.x);
        return end;
    };
    for (const ModelKind kind : {ModelKind::click_torque_wrench, ModelKind::electronic_torque_wrench})
        for (const double size : {8.0, 24.0, 46.0})
            for (const double adaptor : {20.0, 60.0, 300.0})
                for (const Detail detail : {Detail::drawn, Detail::contact}) {
                    ToolParameters p = tool(kind, size);
                    const ToolParameters plain = *completed(p);
                    p.adaptor_length = adaptor * mm;
                    const ToolParameters longer = *completed(p);
                    CAPTURE(description(longer));
                    CHECK(longer.length - plain.length == doctest::Approx(adaptor * mm));
                    const ToolModelParts parts = parts_of(longer, detail), without = parts_of(plain, detail);
                    CHECK(end_of(parts, "insert", true) == doctest::Approx(end_of(without, "insert", true)));
                    CHECK(end_of(parts, "holder", false) - end_of(without, "holder", false) ==
                          doctest::Approx(adaptor));
                    CHECK(end_of(parts, "adaptor", true) > end_of(parts, "holder", false));
                    CHECK(end_of(parts, "adaptor", false) < end_of(parts, "insert", true));
                    for (const ToolModelPart& part : parts)
                        for (const Shell& shell : part.shells) CHECK(unpaired_edges(shell) == 0);
                }
}

TEST_CASE("Tool parameters: the shortest and a long tool of each kind are closed too") {
    for (ToolParameters p : all_tools())
        for (const bool is_long : {false, true}) {
            if (std::lround(p.size / mm) % 4 != 0) continue;
            p.length = 1.0 * mm;
            const std::string refused = error_of(p);
            const std::size_t at = refused.find("expected ") + 9;
            p.length = is_long ? 0.9 : std::stod(refused.substr(at)) * mm;
            const auto made = completed(p);
            REQUIRE(made);
            for (const ToolModelPart& part : parts_of(*made, Detail::drawn))
                for (const Shell& shell : part.shells) {
                    CAPTURE(description(*made));
                    CAPTURE(part.name);
                    CHECK(unpaired_edges(shell) == 0);
                    CHECK(volume(shell) > 0.0);
                }
        }
}

TEST_CASE("Tool parameters: test torques are those that were read, and a power law between them") {
    const auto torque = [](ModelKind kind, double size) { return test_torque(kind, size * mm); };
    CHECK(torque(ModelKind::open_end_wrench, 24).torque == 359.0);
    CHECK(torque(ModelKind::open_end_wrench, 24).source == TorqueSource::tabulated);
    CHECK(torque(ModelKind::ring_wrench, 13).torque == 107.0);
    CHECK(torque(ModelKind::ratchet, 13).torque == 107.0);
    const TestTorque between = torque(ModelKind::ring_wrench, 17);
    CHECK(between.source == TorqueSource::interpolated);
    CHECK(between.torque > 175.0);
    CHECK(between.torque < 230.0);
    CHECK(torque(ModelKind::ring_wrench, 30).source == TorqueSource::estimated);
    CHECK(torque(ModelKind::hex_key, 8).source == TorqueSource::none);
    CHECK(torque(ModelKind::extension_bar, 12.5).torque == 340.0);
    // The power law through its neighbours predicts each inner row within 1 %.
    for (const auto kind : {ModelKind::open_end_wrench, ModelKind::ring_wrench})
        for (const auto& [before, row, after] :
             {std::tuple{10.0, 13.0, 16.0}, {13.0, 16.0, 18.0}, {16.0, 18.0, 24.0}}) {
            const double low = torque(kind, before).torque, high = torque(kind, after).torque;
            const double exponent = std::log(high / low) / std::log(after / before);
            CHECK(low * std::pow(row / before, exponent) ==
                  doctest::Approx(torque(kind, row).torque).epsilon(0.01));
        }
    double last = 0.0;
    for (double size = 5.5; size <= 60.0; size += 0.5) {
        CHECK(torque(ModelKind::open_end_wrench, size).torque > last);
        CHECK(torque(ModelKind::open_end_wrench, size).torque <= torque(ModelKind::ring_wrench, size).torque);
        last = torque(ModelKind::open_end_wrench, size).torque;
    }
}

TEST_CASE("Tool parameters: the arms of keys are those of ISO 2936, and interpolated between its sizes") {
    struct {
        double size, arm, handle;  // mm, for the socket screws M5 to M24
    } const rows[] = {{4, 29, 74},   {5, 33, 85},   {6, 38, 96},   {8, 44, 108},
                      {10, 50, 122}, {14, 70, 154}, {17, 80, 177}, {19, 89, 199}};
    for (const auto& [size, arm, handle] : rows) {
        CHECK(key_arms(size * mm).arm == doctest::Approx(arm * mm));
        CHECK(key_arms(size * mm).handle == doctest::Approx(handle * mm));
    }
    CHECK(key_arms(6.0 * mm).tabulated);
    CHECK_FALSE(key_arms(5.5 * mm).tabulated);
    CHECK(key_arms(5.5 * mm).handle == doctest::Approx(90.5 * mm));
}

TEST_CASE("Tool parameters: every wrench that an assembly can describe has a closed model") {
    for (const double jaw : {3.0, 13.6, 24.2, 150.0})
        for (const double angle : {0.0, 15.0, 45.0, 90.0})
            for (const double handle : {30.0, 140.0, 2000.0})
                for (const double swing : {0.0, 0.07})
                    for (const double share : {0.0, 0.62, 1.3}) {
                        content::WrenchDesign design;
                        design.jaw = jaw * mm;
                        design.head_angle = to_radians(angle);
                        design.handle_length = handle * mm;
                        design.click_swing = swing;
                        design.jaw_depth = design.jaw_tip = share * jaw * mm;
                        design.head_thickness = share > 1.0 ? 1.0 * mm : 0.0;
                        const ToolParameters p = parameters_of(design);
                        CAPTURE(description(p));
                        for (const Detail detail : {Detail::drawn, Detail::contact})
                            for (const ToolModelPart& part : parts_of(p, detail))
                                for (const Shell& shell : part.shells) {
                                    CAPTURE(part.name);
                                    CHECK(unpaired_edges(shell) == 0);
                                    CHECK(volume(shell) > 0.0);
                                    CHECK(all_finite(shell));
                                }
                    }
    content::WrenchDesign design;
    for (const auto& [jaw, size] : {std::pair{24.2, 24.0}, {13.6, 13.0}, {13.0, 13.0}, {18.05, 18.0}}) {
        design.jaw = jaw * mm;
        CHECK(parameters_of(design).size == doctest::Approx(size * mm));
    }
}

}  // namespace tool_models_parameters_test
