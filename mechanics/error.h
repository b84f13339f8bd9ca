#pragma once
// Errors of models. They are expected, so each kind has a type: its message holds the numbers for people, its fields
// hold them for programs. They are thrown while a model is built and solved.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpa::mechanics {

struct MechanicsError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Inverted, flat or broken cells: `cells` lists all of them, the message the first few. Also an impossible box, and a
// mesh whose lists do not fit together, without cells.
struct MeshError : MechanicsError {
    MeshError(const std::string& what, std::vector<int> bad) : MechanicsError(what), cells(std::move(bad)) {}
    std::vector<int> cells;
};

// Moduli that no elastic solid has (`entries` are positions in the list that was given), or lists that do not fit
// together.
struct MaterialError : MechanicsError {
    MaterialError(const std::string& what, std::vector<int> bad) : MechanicsError(what), entries(std::move(bad)) {}
    std::vector<int> entries;
};

// A part that can move freely, or two supports that contradict each other. part: its number, as in Parts of
// mesh_check.h; -1 if the error is not about a part.
struct SupportError : MechanicsError {
    SupportError(const std::string& what, int which) : MechanicsError(what), part(which) {}
    int part;
};

// A load, a tool or a request that cannot be computed with.
struct LoadError : MechanicsError {
    using MechanicsError::MechanicsError;
};

// A solver failed; `code` is the solver's own, 0 without one.
struct SolverError : MechanicsError {
    SolverError(const std::string& what, int solver_code) : MechanicsError(what), code(solver_code) {}
    int code;
};

// There is not enough memory for the factorisation.
struct OutOfMemory : SolverError {
    using SolverError::SolverError;
};

// The work was stopped because Progress::cancel (operators.h) was set.
struct Cancelled : MechanicsError {
    using MechanicsError::MechanicsError;
};

}  // namespace palpa::mechanics
