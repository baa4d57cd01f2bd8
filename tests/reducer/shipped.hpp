// The parts of the reducer's shipped STEP file by name, and measurements on them. The file is read once.
#pragma once

#include <TopoDS_Shape.hxx>
#include <map>
#include <string>
#include <vector>

namespace reducer_test {

struct PlacedPart {
    std::string path;  // names of the groups above it, separated by /
    TopoDS_Shape shape;
};

const std::map<std::string, PlacedPart>& shipped();
const TopoDS_Shape& part(const std::string& name);

double volume(const TopoDS_Shape& shape);
double common_volume(const TopoDS_Shape& a, const TopoDS_Shape& b);
double distance(const TopoDS_Shape& a, const TopoDS_Shape& b);

// z of the crossings of the faces of a shipped part with the line through (x, y) parallel to Z, ascending.
std::vector<double> crossings_z(const TopoDS_Shape& shape, double x, double y);

}  // namespace reducer_test
