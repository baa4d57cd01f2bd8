// The validation against published data, on records whose answer is known.
#include "game/measure/validation.hpp"

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "haptics/joint/group.hpp"
#include "tests/measure/support.hpp"

namespace validation_test {

using namespace measure_test;

namespace {

joint::JointDesign bolt() {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    joint::JointDesign design = loaded.assembly.joints[0].design;
    design.friction.scatter = 0.0;
    return design;
}

// A record of the law itself, loosened from `torque`, with angles stretched by `stretch`.
analysis::MeasuredRecord record_of_law(double torque, double stretch) {
    const joint::JointDesign design = bolt();
    joint::CurveOptions options;
    options.direction = joint::Direction::loosen;
    options.torque = torque;
    analysis::MeasuredRecord record;
    record.file = "law.csv";
    record.direction = joint::Direction::loosen;
    record.cycles.resize(5);
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), options))
        for (analysis::Cycle& cycle : record.cycles) {
            cycle.angle.push_back(-stretch * s.angle);
            cycle.torque.push_back(s.torque);
        }
    return record;
}

}  // namespace

TEST_CASE("Validation: the law agrees with its own loosening run") {
    const auto v = measure::validate_loosening(bolt(), record_of_law(15.0, 1.0));
    REQUIRE(v);
    CHECK(v->law_release == doctest::Approx(v->release).epsilon(0.02));
    CHECK(v->comparison.errors.all.rmse < 0.02 * v->breakaway);
    CHECK(measure::loosening_text(*v).find("agrees with most runs") != std::string::npos);
}

TEST_CASE("Validation: a joint that releases later is reported") {
    const auto v = measure::validate_loosening(bolt(), record_of_law(15.0, 2.0));
    REQUIRE(v);
    CHECK(v->release == doctest::Approx(2.0 * v->law_release).epsilon(0.03));
    CHECK(v->longer == 5);
    CHECK(measure::loosening_text(*v).find("too early: of 5 runs 5 take more") != std::string::npos);
    analysis::MeasuredRecord tightening = record_of_law(15.0, 1.0);
    tightening.direction = joint::Direction::tighten;
    CHECK_FALSE(measure::validate_loosening(bolt(), tightening).has_value());
}

TEST_CASE("Validation: tables of preloads and of re-tightening") {
    const auto exact =
        measure::validate_preload_table("size,class,mu,FM_kN,MA_Nm\nM16,8.8,0.12,80.9,206\n", "a1.csv");
    REQUIRE(exact);
    CHECK(exact->text.find("| 8.8 | 1 | 0.000") != std::string::npos);
    const auto wrong =
        measure::validate_preload_table("size,class,mu,FM_kN,MA_Nm\nM16,8.8,0.12,161.8,206\n", "a1.csv");
    REQUIRE(wrong);
    CHECK(wrong->text.find("the largest error of 50") != std::string::npos);
    CHECK_FALSE(measure::validate_preload_table("size,class,mu,FM_kN,MA_Nm\nM9,8.8,0.12,1,1\n", "a1.csv")
                    .has_value());

    const auto lubricant =
        measure::validate_retightening(bolt(), 20.0, "lube,K=T/(F d)\nbutter,0.2\n", "k.csv");
    REQUIRE_FALSE(lubricant.has_value());
    CHECK(lubricant.error().message() ==
          "k.csv:2: lubrication 'butter' is not known; expected oiled, dry, mos2 or asis");
    const auto steady =
        measure::validate_retightening(bolt(), 20.0, "lube,K=T/(F d)\noiled,0.15\noiled,0.15\n", "k.csv");
    REQUIRE(steady);
    CHECK(steady->text.find("| oiled | 0.1") != std::string::npos);
    REQUIRE(steady->series.size() == 1);
    CHECK(steady->series[0].x == std::vector<double>{1.0, 2.0});
    CHECK(steady->series[0].measured == std::vector<double>{0.15, 0.15});
    CHECK(steady->series[0].law[0] == doctest::Approx(0.15).epsilon(0.01));
}

}  // namespace validation_test
