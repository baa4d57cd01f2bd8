// The faces of a shape, each once, numbered from 1 in an order that depends on the shape alone.
#pragma once

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>

namespace bolt::step_import {

using FaceMap = TopTools_IndexedMapOfShape;

inline FaceMap faces_of(const TopoDS_Shape& shape) {
    FaceMap faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    return faces;
}

}  // namespace bolt::step_import
