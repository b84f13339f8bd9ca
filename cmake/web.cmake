# The app for browsers, by Emscripten (preset `web`): the libraries that Debian keeps as headers, Dear ImGui from its
# sources, and no system below. scripts/setup --web installs the compiler and fetches the sources.

# Never all of /usr/include: its C library is another one. Links to the folders of the headers alone.
set(headers ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${headers})
foreach(library boost glm nlohmann doctest)
    file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()
function(palpa_headers target folder)
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} SYSTEM INTERFACE ${folder})
endfunction()
palpa_headers(Boost::headers ${headers})
palpa_headers(glm::glm ${headers})
palpa_headers(nlohmann_json::nlohmann_json ${headers})
palpa_headers(doctest::doctest ${headers})
palpa_headers(Eigen3::Eigen /usr/include/eigen3)
add_library(PkgConfig::GLES INTERFACE IMPORTED GLOBAL)  # comes with the compiler

add_compile_options(-fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions -Oz)  # the optimiser of WebAssembly goes for size

set(PALPA_IMGUI_SOURCE ${PROJECT_SOURCE_DIR}/build/web-tools/imgui CACHE PATH "Sources of Dear ImGui 1.86")
if(NOT EXISTS ${PALPA_IMGUI_SOURCE}/imgui.cpp)
    message(FATAL_ERROR "${PALPA_IMGUI_SOURCE}: no sources of Dear ImGui; run scripts/setup --web")
endif()
add_library(palpa_imgui STATIC
    ${PALPA_IMGUI_SOURCE}/imgui.cpp
    ${PALPA_IMGUI_SOURCE}/imgui_draw.cpp
    ${PALPA_IMGUI_SOURCE}/imgui_tables.cpp
    ${PALPA_IMGUI_SOURCE}/imgui_widgets.cpp
    ${PALPA_IMGUI_SOURCE}/backends/imgui_impl_opengl3.cpp)
target_include_directories(palpa_imgui SYSTEM PUBLIC ${PALPA_IMGUI_SOURCE})
target_include_directories(palpa_imgui SYSTEM PRIVATE ${PALPA_IMGUI_SOURCE}/backends)
# The desk's library checks how the same screens call it; the texts of its asserts alone are 30 KB to load.
target_compile_definitions(palpa_imgui PRIVATE IMGUI_IMPL_OPENGL_ES3 NDEBUG)
target_compile_options(palpa_imgui PRIVATE -w -Oz)
add_library(PkgConfig::IMGUI ALIAS palpa_imgui)

# The sequential solver of Eigen; MUMPS is Fortran.
set(PALPA_MUMPS OFF CACHE BOOL "" FORCE)
