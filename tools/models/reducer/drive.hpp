// What turns: shafts with their pinions, wheels, keys, sleeves and bearings. In the frame of the reducer.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

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

// Cylindrical roller bearing NJ on its own axis +Z, mid plane z = 0, the inner ring's rib on the +Z side. Two
// of them, ribs towards the shaft's ends, hold a shaft both ways against the axial forces of helical gears.
Result<TopoDS_Shape> roller_bearing(double bore, double outer, double width);

}  // namespace bolt::models::reducer
