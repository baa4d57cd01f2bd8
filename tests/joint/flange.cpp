#include "haptics/joint/group.hpp"

#include <doctest/doctest.h>

#include "tests/joint/support.hpp"

using namespace bolt;
using namespace bolt::joint;

TEST_CASE("Flange: kei agrees with Abramowitz and Stegun, table 9.12") {
    const std::pair<double, double> published[] = {{0.0, -0.7853981634}, {1.0, -0.4949946365},
                                                   {2.0, -0.2024000678}, {3.0, -0.0511218840},
                                                   {4.0, 0.0021983995},  {5.0, 0.0111875865}};
    for (const auto& [x, value] : published) CHECK(std::abs(kelvin_kei(x) - value) < 1e-9);
}

TEST_CASE("Flange: the deflection at the load is Hertz's closed form l2/8D") {
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    CHECK(plate.rigidity == doctest::Approx(110e9 * 0.024 * 0.024 * 0.024 / (12 * (1 - 0.0625))));
    const double hertz = square(plate.length()) / (8 * plate.rigidity);
    CHECK(plate.deflection_per_force(0.0) / hertz == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Flange: neighbours are pressed down nearby and lifted farther out") {
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    CHECK(plate.deflection_per_force(plate.length()) > 0.0);
    CHECK(plate.deflection_per_force(5.0 * plate.length()) < 0.0);
}

TEST_CASE("Flange: the interaction of joints is symmetric and its energy is positive for any forces") {
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    Random random(5);
    std::vector<Vec3> seats;
    for (int i = 0; i < 40; ++i) seats.emplace_back(random.uniform(0, 0.7), 0.0, random.uniform(0, 0.3));
    const InteractionMatrix m = interaction_matrix(plate, seats);
    std::vector<std::vector<double>> dense(40, std::vector<double>(40, 0.0));
    for (std::size_t i = 0; i < 40; ++i) {
        dense[i][i] = m.own_compliance;
        for (std::uint32_t k = m.row_begin[i]; k < m.row_begin[i + 1]; ++k)
            dense[i][m.column[k]] = m.value[k];
    }
    for (std::size_t i = 0; i < 40; ++i)
        for (std::size_t j = 0; j < i; ++j) REQUIRE(dense[i][j] == dense[j][i]);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> F(40);
        for (double& f : F) f = random.normal();
        double energy = 0.0, size = 0.0;
        for (std::size_t i = 0; i < 40; ++i)
            for (std::size_t j = 0; j < 40; ++j) energy += F[i] * dense[i][j] * F[j];
        for (const double f : F) size += f * f;
        REQUIRE(energy >= -1e-3 * m.own_compliance * size);
    }
}

TEST_CASE("Flange: tightening one joint unloads its neighbours, and a second round restores them") {
    std::vector<JointDesign> designs;
    for (int i = 0; i < 4; ++i) {
        JointDesign d = test::m16_flange_joint();
        d.seat = Vec3(0.06 * i, 0.0, 0.0);
        designs.push_back(d);
    }
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const GroupParameters group = make_group(designs, &plate, 1);
    std::vector<JointState> joints = initial_state(group, 4);
    const auto tighten = [&](std::size_t i) {
        while (joints[i].torque < 70.0) turn_nut(group, joints, i, joints[i].nut.angle + 1e-3, 1.0, 1e-3);
    };
    tighten(0);
    const double alone = joints[0].clamp;
    tighten(1);
    const double lost = alone - joints[0].clamp;
    CHECK(lost > 0.02 * alone);
    CHECK(lost < 0.4 * alone);
    tighten(2);
    tighten(3);
    double spread_before = 0.0, spread_after = 0.0;
    const auto spread = [&] {
        double low = 1e9, high = 0.0;
        for (const JointState& j : joints) {
            low = std::min(low, j.clamp);
            high = std::max(high, j.clamp);
        }
        return high / low;
    };
    spread_before = spread();
    for (std::size_t i = 0; i < 4; ++i) {
        joints[i].torque = 0.0;
        tighten(i);
    }
    spread_after = spread();
    CHECK(spread_after < spread_before);
}

TEST_CASE("Flange: the sweep converges to the solution of the equations of all joints") {
    std::vector<JointDesign> designs;
    for (int i = 0; i < 6; ++i) {
        JointDesign d = test::m16_flange_joint();
        d.embedding_time = 1e9;  // no creep during the test
        d.seat = Vec3(0.05 * (i % 3), 0.0, 0.07 * (i / 3));
        designs.push_back(d);
    }
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const GroupParameters group = make_group(designs, &plate, 1);
    std::vector<JointState> joints = initial_state(group, 6);
    for (int round = 0; round < 3; ++round)
        for (std::size_t i = 0; i < 6; ++i)
            while (joints[i].clamp < 15e3) turn_nut(group, joints, i, joints[i].nut.angle + 1e-3, 1.0, 1e-3);
    for (int k = 0; k < 50; ++k) step_group(group, joints, -1, NutDrive{}, 1e-3);
    for (std::size_t i = 0; i < 6; ++i) {
        const MechanisticParameters& p = group.joints[i];
        const MechanisticState& s = joints[i].mechanistic;
        double left =
            p.levers.lead * s.angle - p.start_gap - s.plastic - s.embedding - p.seat.closure(s.clamp);
        for (std::uint32_t k = group.interaction.row_begin[i]; k < group.interaction.row_begin[i + 1]; ++k)
            left -= group.interaction.value[k] * joints[group.interaction.column[k]].clamp;
        CHECK(std::abs(left) < 1e-12);  // m
    }
}
