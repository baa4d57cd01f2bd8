// A low-pass filter without phase shift: a Butterworth filter of second order that runs over the samples
// forwards and backwards (as filtfilt in SciPy and MATLAB does), so that peaks and seats keep their angle.
//
// One pass has the gain 1/√(1 + (Ω/Ω_c)⁴), Ω = tan(π f/f_s) (bilinear transform). Two passes have its square,
// so Ω_c is multiplied by (√2 − 1)^(−1/4): the gain of both is −3 dB at the cut-off (D. A. Winter,
// Biomechanics and Motor Control of Human Movement, 4th ed. 2009, section 2.2.4.4).
//
//   gain(f) = 1 / (1 + (√2 − 1) (tan(π f/f_s) / tan(π f_c/f_s))⁴)
#pragma once

#include <span>
#include <vector>

namespace bolt::measure {

// The highest cut-off frequency as a share of the sampling rate; closer to half the rate the filter does
// nothing useful.
inline constexpr double max_cut_off_share = 0.45;

// The gain of zero_phase_low_pass() for a sine of `frequency`. All in Hz.
double low_pass_gain(double frequency, double cut_off, double rate);

// Filters samples that were taken at `rate` (Hz); 0 < cut_off ≤ max_cut_off_share · rate. The ends are
// continued by their point reflection, so a constant and a straight line pass unchanged.
std::vector<double> zero_phase_low_pass(std::span<const double> samples, double cut_off, double rate);

}  // namespace bolt::measure
