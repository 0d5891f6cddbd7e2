// A model flattened: the bodies it is made of, placed, each with the names of the assemblies it belongs to.
#pragma once

#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "brep/model_shape.hpp"

namespace insym {

struct Body {
    TopoDS_Shape shape;  ///< a solid, or a compound of what is no part of a solid
    std::string part;    ///< the name path of Entity::part
};

/// The bodies in the order of the shape. Parts of one name in one assembly are told apart: bolt#1, bolt#2.
std::vector<Body> find_bodies(const ModelShape& model);

}  // namespace insym
