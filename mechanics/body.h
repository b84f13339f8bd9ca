#pragma once
// A mesh with its materials: what tissues, phantoms, devices and parts are made of.

#include <utility>
#include <vector>

#include "mechanics/material.h"
#include "mechanics/mesh.h"
#include "mechanics/statics.h"

namespace palpa::mechanics {

struct Body {
    Mesh mesh;
    std::vector<Material> materials;  // one per cell
};

// Returns the linear static problem of a body, without supports: the caller adds them.
inline Problem problem_of(Body body, Element element = Element::hex8_bbar) {
    Problem problem;
    problem.mesh = std::move(body.mesh);
    problem.element = element;
    problem.materials = std::move(body.materials);
    return problem;
}

}  // namespace palpa::mechanics
