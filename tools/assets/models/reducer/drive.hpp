// The rotating parts: shafts with their pinions, wheels, keys, sleeves and bearings, in the frame of the
// reducer.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/assets/models/document.hpp"
#include "tools/assets/models/reducer/gear.hpp"

namespace bolt::models::reducer {

struct DrivePart {
    std::string name;
    TopoDS_Shape shape;
    Finish finish;
    std::vector<FaceFinish> faces;
};

Result<DrivePart> input_shaft();
Result<DrivePart> intermediate_shaft();
Result<DrivePart> output_shaft();
Result<DrivePart> first_wheel();
Result<DrivePart> second_wheel();
Result<std::vector<DrivePart>> keys_and_sleeves();

// A helical gear with involute flanks and rack-cut fillets, exact to 3e-4 mm. Its axis is +Z, its mid plane z
// = 0, and the middle of a gap is on +X. `inside` is the outline (radius, z) of the body within the rim, from
// the upper end face to the lower; without it the end faces are full discs.
TopoDS_Shape gear_solid(const GearSpec& gear, const std::vector<std::pair<double, double>>& inside = {});

// A cylindrical roller bearing NJ: axis +Z, mid plane z = 0, the inner ring's rib on the +Z side. Two
// bearings with their ribs towards the shaft's ends take the axial forces of helical gears in both
// directions.
Result<TopoDS_Shape> roller_bearing(double bore, double outer, double width);

}  // namespace bolt::models::reducer
