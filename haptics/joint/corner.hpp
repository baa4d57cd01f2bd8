// What the corners of a nut bear before an open jaw slips over them.
//
// A jaw that turns beyond its play bears on a strip of each flat, from the corner inward, at opposite
// corners. Limit analysis: the strips flow at one pressure p; strips of width b at x1 and x2 from the axis
// and of height e carry T = p e b (x1 + x2 - b), most where b = (x1 + x2)/2:
//
//   T = p e ((x1 + x2)/2)²
//
// p is that of a flat die on one flank of a wedge up to its edge, p = 2k (1 + ψ - π/2) for an obtuse angle ψ
// (R. Hill, The Mathematical Theory of Plasticity, 1950; at ψ = π it is Prandtl's punch), ψ = 120° here and
// 2k = 2/√3 of the flow stress, which is a third of the hardness (D. Tabor, The Hardness of Metals, 1951).
// The hardness is the least that ISO 898-2 asks of a nut's class.
//
// Modelling assumptions: rigid and ideally plastic, the jaw harder than the nut, no friction; a face that is
// tilted bears as far as it stands off by less than the clearance to one side.
#pragma once

#include <string_view>

#include "haptics/joint/design.hpp"

namespace bolt::joint {

// Pa, least Vickers hardness of the nut that belongs to a bolt of this class (ISO 898-2, table of classes 5
// to 12: a nut's class is the first number of the bolt's). Stainless nuts have no such table: three times the
// tensile strength of their grade.
double nut_hardness(const PropertyClass& bolt_class, double d);

// p, Pa.
double corner_pressure(double hardness);

struct CornerGrip {
    double height = 0.0;                             // e, m, in which flat is on flat
    double toward_throat = 0.0, toward_mouth = 0.0;  // x1, x2: m from the axis to the ends of the strips
    double tilt = 0.0;                               // rad, about the flats' length
    double clearance = 0.0;                          // m, half of opening less across flats
    double lost = 0.0;                               // m of the flats that is rounded off at each corner
};

// N·m at which it slips.
double corner_torque(double pressure, const CornerGrip& grip);

// Free turn to either side, rad, of a jaw on a nut of which `lost` m of each flat's ends are gone; 30° where
// it turns round and round.
double rounded_half_play(double opening, double across_flats, double lost);

}  // namespace bolt::joint
