#pragma once
// Cases that several tests solve.

#include <string>

#include "fem/solve.h"
#include "files/text.h"

namespace palpa::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSlow = true;  // instrumented: the largest meshes are left out
#else
inline constexpr bool kSlow = false;
#endif

inline fem::FemCase case_of(const std::string& text, const std::filesystem::path& folder = ".") {
    return fem::parse_case(files::parse_json(text, "c.json"), "c.json", folder);
}

inline fem::FemResult solved(const fem::FemCase& model) {
    return fem::solve_case(model, [](const char*, int, int) {});
}

inline fem::FemResult solved(const std::string& text, const std::filesystem::path& folder = ".") {
    return solved(case_of(text, folder));
}

// A case from its parts; materials and regions may be left to one gel.
inline std::string case_text(const std::string& mesh, const std::string& element, const std::string& supports,
                             const std::string& loads,
                             const std::string& materials = R"({"gel": {"young_Pa": 2500, "poisson": 0.45}})",
                             const std::string& regions = R"([{"all": true, "material": "gel"}])") {
    return "{\"mesh\": " + mesh + ", \"element\": \"" + element + "\", \"materials\": " + materials +
           ", \"regions\": " + regions + ", \"supports\": " + supports + ", \"loads\": " + loads + "}";
}

inline std::string gel(double young_Pa, double poisson) {
    return "{\"gel\": {\"young_Pa\": " + files::number_text(young_Pa) +
           ", \"poisson\": " + files::number_text(poisson) + "}}";
}

inline const std::string kClamped = R"([{"face": "zmin", "fix": "xyz"}])";
inline const std::string kSlab =
    R"({"box": {"size_mm": [100, 100, 50], "elements": [12, 12, 7], "grading": {"centre_mm": [50, 50], "finest_mm": 3}}})";

inline std::string press_at(double x_mm, double y_mm, double diameter_mm, double force_N = 0.025) {
    return R"([{"parabolic_pressure": {"face": "zmax", "centre_mm": [)" + files::number_text(x_mm) + ", " +
           files::number_text(y_mm) + R"(], "diameter_mm": )" + files::number_text(diameter_mm) + R"(, "force_N": )" +
           files::number_text(force_N) + "}}]";
}

}  // namespace palpa::test
