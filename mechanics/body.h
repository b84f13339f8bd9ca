#pragma once
// What tissues, phantoms, devices and parts are made of.

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

// The linear static problem of a body; its supports are still to be given.
inline Problem problem_of(Body body, Element element = Element::hex8_bbar) {
    Problem problem;
    problem.mesh = std::move(body.mesh);
    problem.element = element;
    problem.materials = std::move(body.materials);
    return problem;
}

}  // namespace palpa::mechanics
