// The shipped STEP file of the reducer, read once: every placed part by its name.
#pragma once

#include <TopoDS_Shape.hxx>
#include <map>
#include <string>
#include <vector>

namespace reducer_test {

struct Placed {
    std::string path;  // names of the groups above it
    TopoDS_Shape shape;
};

const std::map<std::string, Placed>& shipped();
const TopoDS_Shape& part(const std::string& name);
std::vector<std::string> names_with(const std::string& start);

double volume(const TopoDS_Shape& shape);
double common_volume(const TopoDS_Shape& a, const TopoDS_Shape& b);
double distance(const TopoDS_Shape& a, const TopoDS_Shape& b);

// Where a line parallel to Z crosses the faces of a shipped part, in ascending order.
std::vector<double> crossings_z(const TopoDS_Shape& shape, double x, double y);

}  // namespace reducer_test
