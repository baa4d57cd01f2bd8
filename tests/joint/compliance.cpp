#include "haptics/joint/design.hpp"

#include <doctest/doctest.h>

using namespace bolt;
using namespace bolt::joint;

TEST_CASE("Compliance: a fully threaded M16 in steel needs 23, 35 and 56 degrees from snug to 80.9 kN") {
    const ThreadSize m16 = parse_thread("M16").value();
    const std::pair<double, double> published[] = {{20e-3, 23.0}, {40e-3, 35.0}, {80e-3, 56.0}};
    for (const auto& [grip, degrees] : published) {
        const Member steel{grip, 205e9};
        const double compliance = bolt_compliance(m16.thread, 205e9, grip, 0.0) +
                                  member_compliance({&steel, 1}, m16.size.nut_bearing, m16.size.hole, 0.0);
        CHECK(80.9e3 * compliance / m16.thread.pitch * 360.0 == doctest::Approx(degrees).epsilon(0.05));
    }
}

TEST_CASE("Compliance: the cone of a member as wide as the bearing is a cylinder") {
    const Member layer{0.05, 110e9};
    const double sleeve = 0.05 / 110e9 / (0.25 * pi * (square(0.0225) - square(0.0175)));
    CHECK(member_compliance({&layer, 1}, 0.0225, 0.0175, 0.0225) / sleeve ==
          doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE(
    "Compliance: the cone's closed form equals numerical integration, also cut by the outer diameter and "
    "over two layers") {
    const Member layers[] = {{0.030, 110e9}, {0.012, 70e9}, {0.040, 205e9}};
    constexpr double d_w = 0.0225, hole = 0.0175;
    for (const double D_A : {0.0, 0.030, 0.040, 0.080}) {
        constexpr double grip = 0.082;
        const double y = (D_A > d_w ? D_A : 3 * d_w) / d_w;
        const double tan_phi = 0.362 + 0.032 * std::log(0.5 * grip / d_w) + 0.153 * std::log(y);
        double sum = 0.0;
        constexpr int n = 400'000;
        for (int i = 0; i < n; ++i) {
            const double z = (i + 0.5) * grip / n;
            double D = d_w + 2.0 * tan_phi * std::min(z, grip - z);
            if (D_A > 0.0) D = std::min(D, D_A);
            const double E = z < 0.030 ? 110e9 : z < 0.042 ? 70e9 : 205e9;
            sum += grip / n / (E * 0.25 * pi * (square(D) - square(hole)));
        }
        CHECK(member_compliance(layers, d_w, hole, D_A) / sum == doctest::Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("Compliance: longer grips, softer members and thinner shanks are more compliant") {
    const ThreadSize m16 = parse_thread("M16").value();
    CHECK(bolt_compliance(m16.thread, 205e9, 0.1, 0.0) > bolt_compliance(m16.thread, 205e9, 0.1, 0.05));
    CHECK(bolt_compliance(m16.thread, 205e9, 0.1, 0.05) > bolt_compliance(m16.thread, 205e9, 0.08, 0.05));
    const Member iron{0.1, 110e9}, steel{0.1, 205e9};
    CHECK(member_compliance({&iron, 1}, 0.0225, 0.0175, 0.0) >
          member_compliance({&steel, 1}, 0.0225, 0.0175, 0.0));
}
