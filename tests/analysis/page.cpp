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
    // The table has six columns, so it is below its plot. On paper a column may be narrower than its content.
    CHECK(has(page, "<div class=\"grid wide\">"));
    const std::string print = page.substr(page.find("@media print"));
    CHECK(has(print, ".grid{grid-template-columns:repeat(2,minmax(0,1fr))"));
    CHECK(has(print, ".wide{grid-template-columns:minmax(0,1fr)}"));
    CHECK_FALSE(has(page, "<script"));
    CHECK(has(page, "<dd>out/<wbr/>Rig &amp; Co</dd>"));
}

TEST_CASE("Comparison page: names with markup are escaped") {
    const Comparison c = comparison_of(2, "</style></svg><script>\"' x=\"");
    const std::string page = comparison_page(c);
    CHECK(markup_fault(page) == "");
    CHECK_FALSE(has(page, "<script"));
}

TEST_CASE("Comparison page: a record of another joint has a label and no errors") {
    Comparison c = comparison_of(4, "rig");
    CHECK_FALSE(has(console_text(c), "another joint"));
    CHECK(has(console_text(c), "slope in linearity: virtual"));
    CHECK(has(comparison_page(c), " … "));
    std::vector<MeasuredCurve> small = c.measured;
    for (MeasuredCurve& curve : small)
        for (double& torque : curve.curve.torque) torque *= 0.02;
    auto joint = analysis::compare_joint("B1", c.joints[0].simulated, small);
    REQUIRE(joint);
    CHECK(has(joint->mismatch_reason, "differ by a factor of 5"));
    CHECK(joint->errors.all.count == 0);
    c.measured = small;
    c.joints = {*joint};
    c.errors = joint->errors;
    for (const std::string& text : {console_text(c), comparison_page(c)}) {
        CHECK(
            has(text,
                "another joint, or the same one in another state: the peak torques differ by a factor of 5"));
        CHECK_FALSE(has(text, "MAPE 0"));
        CHECK_FALSE(has(text, "all stages"));
    }
    CHECK(markup_fault(comparison_page(c)) == "");

    analysis::ComparisonOptions asserted;
    asserted.same_joint = true;
    joint = analysis::compare_joint("B1", c.joints[0].simulated, small, asserted);
    REQUIRE(joint);
    CHECK(joint->mismatch_reason.empty());
    CHECK(joint->errors.all.count > 0);
}

TEST_CASE("Comparison page: closed-form curves have small errors, and every sample is counted") {
    const Comparison c = comparison_of(1, "rig");
    // Aligned at a common torque, the curves differ by less than 5 %.
    CHECK(c.errors.stage[static_cast<std::size_t>(joint::Stage::navigation)].mape ==
          doctest::Approx(0.05).epsilon(0.1));
    CHECK(c.errors.stage[static_cast<std::size_t>(joint::Stage::linearity)].mape < 0.03);
    CHECK(c.errors.all.count + c.errors.all.below + c.errors.outside == c.measured[0].curve.size());
}

TEST_CASE("Comparison page: a joint with another slope has a label and no errors") {
    Comparison c = comparison_of(4, "rig");
    const analysis::TorqueCurve& ours = c.joints[0].simulated;
    std::vector<MeasuredCurve> softer = c.measured;  // as high, but over 1.5 times the angle
    for (MeasuredCurve& curve : softer)
        for (double& angle : curve.curve.angle) angle *= 1.5;
    auto joint = analysis::compare_joint("B1", ours, softer);
    REQUIRE(joint);
    CHECK(joint->mismatch_reason ==
          "the torque rises in linearity by a factor of 1.51 more steeply than measured; expected at most "
          "1.4 for one joint");
    CHECK(joint->errors.all.count == 0);
    CHECK(std::isnan(joint->cycles[0].slope_error));
    analysis::ComparisonOptions asserted;
    asserted.same_joint = true;
    joint = analysis::compare_joint("B1", ours, softer, asserted);
    REQUIRE(joint);
    CHECK(joint->mismatch_reason.empty());
    CHECK(joint->errors.all.count > 0);
}

TEST_CASE("Comparison page: a joint that keeps its load over three times the angle has no errors") {
    const analysis::TorqueCurve ours = curve_of(loosening_torque, 0.0, 120.0, 0.1, Direction::loosen);
    const auto held = [](double at) { return loosening_torque(at / 3.0); };
    const std::vector<MeasuredCurve> measured{{"1", curve_of(held, 0.0, 120.0, 5.0, Direction::loosen)}};
    const auto joint = analysis::compare_joint("B1", ours, measured);
    REQUIRE(joint);
    CHECK_MESSAGE(has(joint->mismatch_reason, "falls after the breakaway by a factor of 3."),
                  joint->mismatch_reason);
    CHECK(joint->errors.all.count == 0);
    const auto same = analysis::compare_joint(
        "B1", ours, {{"1", curve_of(loosening_torque, 0.0, 120.0, 5.0, Direction::loosen)}});
    REQUIRE(same);
    CHECK_MESSAGE(same->mismatch_reason.empty(), same->mismatch_reason);
}
