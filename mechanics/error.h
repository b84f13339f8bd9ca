#pragma once
// What goes wrong with a model is expected and typed: the message holds the numbers, the fields hold them
// again for a program. Thrown while a model is built; nothing throws inside a contact step.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpa::mechanics {

struct MechanicsError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Inverted, flat or broken cells; `cells` lists all of them, the message the first few.
struct MeshError : MechanicsError {
    MeshError(const std::string& what, std::vector<int> bad) : MechanicsError(what), cells(std::move(bad)) {}
    std::vector<int> cells;
};

// Moduli that no elastic solid has; `entries` are positions in the list that was given.
struct MaterialError : MechanicsError {
    MaterialError(const std::string& what, std::vector<int> bad) : MechanicsError(what), entries(std::move(bad)) {}
    std::vector<int> entries;
};

// A part that can move freely, or two supports that contradict each other. part: -1 when it is not about one.
struct SupportError : MechanicsError {
    SupportError(const std::string& what, int which) : MechanicsError(what), part(which) {}
    int part;
};

struct LoadError : MechanicsError {
    using MechanicsError::MechanicsError;
};

// The factorisation failed; `code` is the solver's own.
struct SolverError : MechanicsError {
    SolverError(const std::string& what, int solver_code) : MechanicsError(what), code(solver_code) {}
    int code;
};

// There is not enough memory for the factorisation.
struct OutOfMemory : SolverError {
    using SolverError::SolverError;
};

struct Cancelled : MechanicsError {
    using MechanicsError::MechanicsError;
};

}  // namespace palpa::mechanics
