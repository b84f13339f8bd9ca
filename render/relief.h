#pragma once
// The vertices of the drawn surface: close together where the indenter touches, wider apart elsewhere.

#include <glm/vec2.hpp>
#include <vector>

#include "render/tissue.h"

namespace palpa::render {

// Moves u in 0 ... 1 so that even steps become 4.5 times closer at the focus, and wider far from it. 0, 1 and the focus
// stay where they are. The shader of the surface has the same formula.
float crowded(float u, float focus);

// Returns the place of the contact in 0 ... 1 of the tissue's width and height.
glm::vec2 focus_of(const TissuePicture& picture);

// Returns the sink of the relief at the vertices of the drawn surface, (cells + 3)^2 of (sink, d sink/dx, d sink/dy), x
// fastest: at the places crowded(i / cells, focus), and once more at the first and the last of each axis, for the block's
// sides. Catmull-Rom interpolation, which continues the values at the border. Needs relief.n_x and n_y >= 2. `rows` is
// scratch memory.
void refine(const Relief& relief, const glm::vec2& size_m, int cells, const glm::vec2& focus, std::vector<float>& rows,
            std::vector<float>& out);

// Returns the sink of a dent or a relief at a place, linear between its values.
float sink_m(const Dent& dent, const glm::vec2& p_m);
float sink_m(const Relief& relief, const TissueView& view, const glm::vec2& p_m);

}  // namespace palpa::render
