# Headers that most sources parse, compiled once. Sources still name all that they need: the presets tsan, fuzz and web
# build without this.
#
# A precompiled header serves sources of the same flags only: there is one for the libraries and one for each level of
# optimisation of the tests. What compiles at PALPA_LITTLE beside others in one target does without.
option(PALPA_PRECOMPILE "Precompile the headers that most sources parse" ON)
if(NOT PALPA_PRECOMPILE OR EMSCRIPTEN)
    function(palpa_precompiled)
    endfunction()
    return()
endif()

set(PALPA_HEADERS <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits>
    <map> <memory> <nlohmann/json.hpp> <numbers> <optional> <set> <span> <sstream> <string> <string_view> <tuple> <utility>
    <variant> <vector>)

# palpa_precompiled(TARGET... [NAME name] [HEADERS ...]): TARGET... share one header of PALPA_HEADERS and HEADERS.
function(palpa_precompiled)
    cmake_parse_arguments(ARG "" "NAME" "HEADERS" ${ARGN})
    set(name palpa_precompiled_${ARG_NAME})
    if(NOT TARGET ${name})
        file(CONFIGURE OUTPUT ${name}.cpp CONTENT "")
        palpa_library(precompiled_${ARG_NAME} SOURCES ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp USES Eigen3::Eigen)
        target_precompile_headers(${name} PRIVATE ${PALPA_HEADERS} ${ARG_HEADERS})
    endif()
    foreach(target ${ARG_UNPARSED_ARGUMENTS})
        target_precompile_headers(${target} REUSE_FROM ${name})
    endforeach()
endfunction()
