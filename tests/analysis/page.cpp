#include "game/report/report.hpp"

#include <doctest/doctest.h>

#include "game/plot/html.hpp"
#include "tests/analysis/curves.hpp"
#include "tests/report/well_formed.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::report;
using joint::Direction;
using report::markup_fault;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Comparison comparison_of(int cycles, const std::string& words) {
    Comparison c;
    c.session = "out/" + words;
    c.title = c.law = c.variant = c.measured_file = c.source = words;
    c.direction = Direction::tighten;
    for (int i = 0; i < cycles; ++i)
        c.measured.push_back({words, curve_of(tightening_torque, 5.0 * i, 95.0, 1.0, Direction::tighten)});
    const analysis::TorqueCurve ours =
        curve_of([](double at) { return 1.05 * tightening_torque(at); }, 0.0, 95.0, 0.1, Direction::tighten);
    c.options.floor_share = 1e-3;  // navigation has 0.5 N·m of 105
    Result<JointComparison> joint = compare_joint(words, ours, c.measured, c.options);
    REQUIRE(joint);
    c.errors = joint->errors;
    c.joints.push_back(std::move(*joint));
    return c;
}

}  // namespace

TEST_CASE("Comparison page: page and console name the source and give the errors") {
    const Comparison c = comparison_of(3, "Rig & Co");
    const std::string page = comparison_page(c), text = console_text(c);
    CHECK(markup_fault(page) == "");
    CHECK(has(page, "Measured by Rig &amp; Co"));
    CHECK(has(text, "measured by: Rig & Co"));
    for (const StageError& stage : c.joints[0].errors.stage) {
        REQUIRE(stage.count > 0);
        CHECK(has(page, plot::number(stage.mre, 5)));
        CHECK(has(text, plot::number(stage.mape, 5)));
    }
    CHECK_FALSE(has(page, "<script"));
    CHECK(has(page, "<dd>out/<wbr/>Rig &amp; Co</dd>"));
}

TEST_CASE("Comparison page: names with markup are escaped") {
    const Comparison c = comparison_of(2, "</style></svg><script>\"' x=\"");
    const std::string page = comparison_page(c);
    CHECK(markup_fault(page) == "");
    CHECK_FALSE(has(page, "<script"));
}

TEST_CASE("Comparison page: a remark names peaks that do not match") {
    Comparison c = comparison_of(1, "rig");
    CHECK_FALSE(has(console_text(c), "factor"));
    for (double& torque : c.measured[0].curve.torque) torque *= 0.02;
    CHECK(has(console_text(c), "The peaks differ by a factor of up to 5"));
}

TEST_CASE("Comparison page: closed-form curves have small errors, and every sample is counted") {
    const Comparison c = comparison_of(1, "rig");
    // Aligned at a common torque, the curves differ by less than 5 %.
    CHECK(c.errors.stage[static_cast<std::size_t>(joint::Stage::navigation)].mape ==
          doctest::Approx(0.05).epsilon(0.1));
    CHECK(c.errors.stage[static_cast<std::size_t>(joint::Stage::linearity)].mape < 0.03);
    CHECK(c.errors.all.count + c.errors.all.below + c.errors.outside == c.measured[0].curve.size());
}
