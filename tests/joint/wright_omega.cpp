#include "haptics/joint/seat_spring.hpp"

#include <doctest/doctest.h>

#include <initializer_list>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::joint;

TEST_CASE("Wright omega: omega(1) = 1, omega(0) = 0.567143..., omega(1 + e) = e") {
    CHECK(wright_omega(1.0) == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(wright_omega(0.0) == doctest::Approx(0.56714329040978387300).epsilon(1e-15));
    CHECK(wright_omega(1.0 + std::exp(1.0)) == doctest::Approx(std::exp(1.0)).epsilon(1e-15));
    CHECK(wright_omega(-1000.0) == 0.0);
}

TEST_CASE("Wright omega: omega + ln omega = x over the whole range, and omega is monotonic") {
    Random random(3);
    for (int i = 0; i < 200'000; ++i) {
        const double x = i < 100'000 ? random.uniform(-40.0, 40.0) : random.uniform(-600.0, 1e7);
        const double w = wright_omega(x);
        REQUIRE(w > 0.0);
        REQUIRE(std::abs(w + std::log(w) - x) <= 4e-15 * (1.0 + std::abs(x)));
    }
    double last = 0.0;
    for (double x = -50.0; x < 60.0; x += 1e-3) {
        const double w = wright_omega(x);
        REQUIRE(w > last);
        last = w;
    }
}

TEST_CASE("Wright omega: a bad initial value changes the number of steps, not the result") {
    Random random(4);
    for (int i = 0; i < 200'000; ++i) {
        const double x = i < 100'000 ? random.uniform(-40.0, 40.0) : random.uniform(0.0, 1e4);
        const double w = wright_omega(x);
        const double off = std::exp(random.uniform(-20.0, 6.0));
        for (const double near : {w * (1.0 + off), w / (1.0 + off), 0.0, -1.0})
            REQUIRE(std::abs(wright_omega(x, near) - w) <= 1e-15 * (1.0 + std::max(0.0, -x)) * w);
    }
    CHECK(std::isnan(wright_omega(std::nan(""), 1.0)));
    CHECK(wright_omega(2.0, std::nan("")) == wright_omega(2.0));
}

TEST_CASE("Wright omega: the seat spring inverts its closure, is positive, and approaches the elastic line") {
    const SeatSpring seat{5.5e-9, 6.5e-6, 31.4};
    for (const double force : {1e-6, 1.0, 31.4, 1e3, 3e4, 1e5}) {
        CHECK(seat.at(seat.closure(force)).force == doctest::Approx(force).epsilon(1e-12));
    }
    CHECK(seat.at(0.0).force < seat.touch_force);
    CHECK(seat.at(-1.0).force == 0.0);  // 1 m away: exactly zero, no denormal
    CHECK(seat.at(1e-3).stiffness == doctest::Approx(1.0 / seat.compliance).epsilon(0.01));
    for (double x = -1e-4; x < 4e-4; x += 1e-6) {
        const double h = 1e-10;
        const double slope = (seat.at(x + h).force - seat.at(x - h).force) / (2.0 * h);
        CHECK(seat.at(x).stiffness == doctest::Approx(slope).epsilon(1e-4));
    }
}
