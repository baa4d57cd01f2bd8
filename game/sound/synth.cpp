#include "game/sound/synth.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::sound {

namespace {

constexpr double inaudible = 1e-7;  // of full scale, −140 dB; a resonator below this level stops

}  // namespace

ResonatorBank::ResonatorBank(std::span<const ResonatorMode> modes, double rate) {
    for (const ResonatorMode& mode : modes) {
        if (count_ == most || mode.frequency > 0.45 * rate) continue;
        Resonator& resonator = resonators_[count_++];
        resonator.rotation =
            std::polar(std::exp(-1.0 / (mode.decay * rate)), 2.0 * pi * mode.frequency / rate);
        resonator.level = mode.level;
    }
}

double ResonatorBank::next(double force) {
    if (!rings_ && force == 0.0) return 0.0;
    double sum = 0.0;
    double loudest = std::abs(force);
    for (std::size_t i = 0; i < count_; ++i) {
        Resonator& r = resonators_[i];
        const double re = r.state.real() * r.rotation.real() - r.state.imag() * r.rotation.imag() + force;
        const double im = r.state.real() * r.rotation.imag() + r.state.imag() * r.rotation.real();
        r.state = {re, im};
        sum += r.level * im;
        loudest = std::max({loudest, std::abs(re), std::abs(im)});
    }
    rings_ = loudest > inaudible;
    if (!rings_)
        for (Resonator& r : resonators_) r.state = 0.0;
    return sum;
}

double ForcePulse::next() {
    if (area == 0.0) return 0.0;
    age += 1.0;
    if (age <= 0.0) return 0.0;
    if (age >= length) {
        area = 0.0;
        return 0.0;
    }
    return area / length * (1.0 - std::cos(2.0 * pi * age / length));
}

void ForcePulses::add(double area, double length, double delay) {
    if (area == 0.0) return;
    for (ForcePulse& p : pulses_) {
        if (p.area != 0.0) continue;
        p = {area, std::max(length, 2.0), -std::floor(delay)};
        ++count_;
        return;
    }
}

double ForcePulses::next() {
    if (count_ == 0) return 0.0;
    double sum = 0.0;
    for (ForcePulse& p : pulses_) {
        if (p.area == 0.0) continue;
        sum += p.next();
        if (p.area == 0.0) --count_;
    }
    return sum;
}

namespace {

// Levels, of full scale, before the limiter. Chosen from the waveforms of lessons.
constexpr double strike_level = 0.55, scrape_gain = 0.5, run_level = 0.06, run_pulse_level = 0.08,
                 creep_level = 0.2, click_level = 0.5, slip_level = 1.2, crackle_level = 0.04,
                 tooth_level = 0.08, bell_level = 0.16, gong_level = 0.22;

constexpr double smoothing_time = 4e-3, crackle_time = 25e-3;  // s

// Bending modes of a free steel bar: (k L)² relative to the first mode, k L = 4.730 (Blevins, Formulas for
// Natural Frequency and Mode Shape, 1979). The hand that holds the bar damps the low modes least.
constexpr double bar_ratios[] = {1.0, 2.757, 5.404, 8.933, 13.34};
constexpr double bar_decays[] = {0.06, 0.045, 0.03, 0.02, 0.015};  // s
constexpr double bar_levels[] = {1.0, 0.8, 0.6, 0.4, 0.25};
constexpr double speed_of_sound = 5170.0;  // m/s along a steel bar, √(E/ρ)

// Hz of the first mode. `length`, `height`: m.
double bar_frequency(double length, double height) {
    // 4.730²/(2π √12) c h / L²
    return 1.028 * speed_of_sound * height / square(length);
}

ResonatorBank make_wrench(const servo::Wrench& wrench, double rate) {
    // The handle ends a little beyond the grip and has two thirds of the head's thickness.
    const double length = std::max(1.15 * wrench.handle_length, 0.05);
    const double height = std::max(0.66 * collision::thickness(wrench.head), 2e-3);
    std::array<ResonatorMode, 5> modes;
    for (std::size_t i = 0; i < modes.size(); ++i)
        modes[i] = {bar_frequency(length, height) * bar_ratios[i], bar_decays[i], bar_levels[i]};
    return {modes, rate};
}

// A hollow casting of cast iron, whose graphite damps it. The values of this bank and of the
// next two are design choices.
constexpr ResonatorMode casing_modes[] = {{173, 0.05, 1.0}, {291, 0.04, 0.9},   {468, 0.03, 0.7},
                                          {742, 0.02, 0.5}, {1130, 0.015, 0.4}, {1730, 0.01, 0.3}};
// A nut on its bolt: high and short.
constexpr ResonatorMode nut_modes[] = {{2870, 0.02, 1.0}, {4330, 0.015, 0.7}, {6120, 0.01, 0.4}};
// Joint and wrench together, excited while the bolt is being stretched.
constexpr ResonatorMode creep_modes[] = {
    {187, 0.03, 1.0}, {311, 0.025, 0.8}, {534, 0.015, 0.6}, {905, 0.01, 0.3}};
constexpr ResonatorMode ratchet_modes[] = {{1860, 0.012, 0.8}, {3170, 0.01, 1.0}, {4720, 0.006, 0.6}};
// Chimes: two notes a fifth apart, and a low one. They are unlike any sound of steel.
constexpr ResonatorMode bell_modes[] = {{784.0, 0.25, 1.0}, {1568.0, 0.15, 0.2}};
constexpr ResonatorMode second_bell_modes[] = {{1174.7, 0.3, 1.0}, {2349.3, 0.15, 0.2}};
constexpr ResonatorMode gong_modes[] = {{146.8, 0.3, 1.0}, {220.2, 0.2, 0.6}, {293.7, 0.15, 0.3}};

constexpr double half_level_speed = 0.3;  // m/s; a strike at this speed has half the greatest level

// s. Hertz's contact time is inversely proportional to the fifth root of the speed. The factors are for a
// steel wrench of about 0.3 kg; on a painted casting the contact is longer.
double contact_time(double speed, StruckSurface surface) {
    return (surface == StruckSurface::nut ? 0.12e-3 : 0.35e-3) * std::pow(std::max(speed, 1e-3), -0.2);
}

constexpr double roughness = 0.25e-3;               // m between the ridges of the surface
constexpr double full_force = 10.0;                 // N, at and above which the scrape is loudest
constexpr double full_slide = 0.15;                 // m/s, likewise
constexpr std::uint32_t band_update_interval = 16;  // samples between updates of the band

constexpr double full_run = 8.0;      // rad/s of a nut that is spun fast with the fingers
constexpr double max_pitch = 3000.0;  // Hz
constexpr double tone_from = 150.0;   // Hz; single pulses below, a tone above

// rad of rotation before a stuck nut slips: stick_angle, and at full load up to extra_stick_angle more.
constexpr double stick_angle = 0.004, extra_stick_angle = 0.012;
constexpr double max_slips = 300.0;  // 1/s

// Clamps to 0 … `most`; returns 0 if the value is not finite.
double sanitized(float value, double most) {
    return std::isfinite(value) ? std::clamp(static_cast<double>(value), 0.0, most) : 0.0;
}

// Linear up to 0.5; from there a curve that stays below 1.
double soft_limit(double x) {
    const double beyond = std::abs(x) - 0.5;
    return beyond <= 0.0 ? x : std::copysign(0.5 + 0.49 * std::tanh(beyond / 0.49), x);
}

double white(Random& noise) { return 2.0 * noise.uniform() - 1.0; }

// Adds a pulse that excites a bank to about `level`: a short pulse gives each mode an amplitude of the mode's
// level times the pulse's area. `seconds`, `delay`: s.
void hit(ForcePulses& pulses, double level, double seconds, double rate, double delay = 0.0) {
    pulses.add(level, seconds * rate, delay * rate);
}

double scrape(Synth& s) {
    const double slide = s.slide_speed.next(s.smoothing), force = s.contact_force.next(s.smoothing);
    if (slide == 0.0 || force == 0.0) {
        s.scrape *= 0.99;
        if (std::abs(s.scrape) < 1e-7) {
            s.scrape = 0.0;
            return 0.0;
        }
    }
    if (s.sample_count % band_update_interval == 0) {
        const double centre = std::clamp(slide / roughness, 250.0, 5000.0);
        const double shrink = std::exp(-pi * 0.8 * centre / s.rate);
        s.scrape_rotation = std::polar(shrink, 2.0 * pi * centre / s.rate);
        s.scrape_level = std::sqrt(1.0 - square(shrink));
    }
    const double level = std::min(1.0, slide / full_slide) * std::sqrt(std::min(1.0, force / full_force));
    s.scrape = s.scrape * s.scrape_rotation + s.scrape_level * level * white(s.noise);
    return scrape_gain * s.scrape.imag();
}

double run(Synth& s) {
    const double speed = s.run_speed.next(s.smoothing);
    if (speed == 0.0) return 0.0;
    const double pitch = std::min(pulses_per_turn * speed / (2.0 * pi), max_pitch);
    const double level = std::min(1.0, speed / full_run);
    s.run_phase += pitch / s.rate;
    if (s.run_phase >= 1.0) {
        s.run_phase -= 1.0;
        const double run_pulse_share = square(tone_from / (tone_from + pitch));
        s.nut_pulses.add(run_pulse_level * run_pulse_share * (0.3 + 0.7 * level) * s.noise.uniform(0.6, 1.0),
                         0.15e-3 * s.rate);
    }
    // At pitches too low to be perceived as a tone only the pulses sound.
    const double tone_share = square(pitch) / (square(pitch) + square(tone_from));
    const double angle = 2.0 * pi * s.run_phase;
    return run_level * level * tone_share *
           (std::sin(angle) + 0.4 * std::sin(2.0 * angle) + 0.2 * std::sin(3.0 * angle));
}

double creep(Synth& s) {
    const double speed = s.creep_speed.next(s.smoothing), load = s.load.next(s.smoothing);
    if (speed > 0.0 && load > 0.0) {
        s.stuck_angle += speed / s.rate;
        if (s.stuck_angle > s.release_angle) {
            s.stuck_angle = 0.0;
            const double angle = stick_angle + extra_stick_angle * std::min(1.0, load) * s.noise.uniform();
            s.release_angle = std::max(angle, speed / max_slips);
            hit(s.creep_pulses, creep_level * square(load) * s.noise.uniform(0.5, 1.0), 0.8e-3, s.rate);
        }
    }
    return s.creep.next(s.creep_pulses.next());
}

// Noise of steel that is scraped off the nut's corners.
double crackle(Synth& s) {
    if (s.crackle == 0.0) return 0.0;
    s.crackle *= s.crackle_decay;
    if (s.crackle < 1e-4) s.crackle = 0.0;
    return crackle_level * s.crackle * white(s.noise);
}

}  // namespace

double SmoothedValue::next(double share) {
    value += share * (target - value);
    if (std::abs(target - value) < 1e-7) value = target;
    return value;
}

Synth make_synth(const servo::Setup& setup, int rate, std::uint64_t seed) {
    Synth s;
    s.rate = rate;
    s.smoothing = 1.0 - std::exp(-1.0 / (smoothing_time * s.rate));
    s.crackle_decay = std::exp(-1.0 / (crackle_time * s.rate));
    s.noise = Random(seed, 7);
    s.wrench = make_wrench(setup.wrench, s.rate);
    s.casing = {casing_modes, s.rate};
    s.nut = {nut_modes, s.rate};
    s.creep = {creep_modes, s.rate};
    s.ratchet = {ratchet_modes, s.rate};
    s.bell = {bell_modes, s.rate};
    s.second_bell = {second_bell_modes, s.rate};
    s.gong = {gong_modes, s.rate};
    s.release_angle = stick_angle;
    return s;
}

void apply_cues(Synth& s, const SoundCues& cues) {
    if (const double speed = sanitized(cues.strike_speed, 10.0); speed > 0.0) {
        const double level = strike_level * speed / (speed + half_level_speed);
        const double seconds = contact_time(speed, cues.surface);
        hit(s.wrench_pulses, 0.5 * level, seconds, s.rate);
        if (cues.surface == StruckSurface::nut)
            hit(s.nut_pulses, 0.35 * level, seconds, s.rate);
        else
            hit(s.casing_pulses, 0.5 * level, seconds, s.rate);
    }
    s.slide_speed.target = sanitized(cues.slide_speed, 3.0);
    s.contact_force.target = sanitized(cues.contact_force, 100.0);
    s.run_speed.target = sanitized(cues.run_speed, 200.0);
    s.creep_speed.target = sanitized(cues.creep_speed, 50.0);
    s.load.target = sanitized(cues.load, 1.5);
    if (const double strength = sanitized(cues.slip, 1.5); strength > 0.0) {
        hit(s.wrench_pulses, slip_level * (0.3 + 0.7 * strength), 0.2e-3, s.rate);
        hit(s.nut_pulses, slip_level * (0.3 + 0.7 * strength), 0.15e-3, s.rate);
        s.crackle = std::min(1.0, s.crackle + 0.3 + 0.7 * strength);
    }
    if (cues.click) {
        hit(s.ratchet_pulses, click_level, 0.3e-3, s.rate);
        hit(s.ratchet_pulses, 0.4 * click_level, 0.3e-3, s.rate, 0.018);
    }
    if (cues.tooth && s.since_tooth >= 1.0 / max_teeth) {
        hit(s.ratchet_pulses, tooth_level, 0.2e-3, s.rate);
        s.since_tooth = 0.0;
    }
    if (cues.done) {
        hit(s.bell_pulses, bell_level, 0.5e-3, s.rate);
        hit(s.second_bell_pulses, bell_level, 0.5e-3, s.rate, 0.12);
    }
    if (cues.mistake) hit(s.gong_pulses, gong_level, 2e-3, s.rate);
}

void fade_out(Synth& s) { apply_cues(s, {}); }

void render(Synth& s, std::span<float> samples) {
    const double step = max_slope / s.rate;
    for (float& sample : samples) {
        double sum = scrape(s) + run(s) + creep(s);
        sum += s.wrench.next(s.wrench_pulses.next()) + s.casing.next(s.casing_pulses.next());
        sum += s.nut.next(s.nut_pulses.next() + crackle(s)) + s.ratchet.next(s.ratchet_pulses.next());
        sum += s.bell.next(s.bell_pulses.next()) + s.second_bell.next(s.second_bell_pulses.next());
        sum += s.gong.next(s.gong_pulses.next());
        s.last_sample += std::clamp(soft_limit(sum) - s.last_sample, -step, step);
        sample = static_cast<float>(s.last_sample);
        ++s.sample_count;
        s.since_tooth += 1.0 / s.rate;
    }
}

}  // namespace bolt::sound
